// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Functions that exist twice: for any processor, and for those with AVX2. That brings no fused multiply-add:
// the bits are the same.
#pragma once

// GCC and clang compile functions for other processors than the rest of a file.
#ifdef __x86_64__
#ifdef __GNUC__
#define EGOCAL_WIDE_LANES
#endif
#endif

namespace egocal::detail {

#ifdef EGOCAL_WIDE_LANES
/// Whether this processor has AVX2.
inline bool has_wide_lanes() {
  static const bool is_wide = __builtin_cpu_supports("avx2") != 0;
  return is_wide;
}
#endif

}  // namespace egocal::detail
