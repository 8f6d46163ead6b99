// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace egocal::detail {

/// The block that an instant is in: index / length. Lengths are powers of two, as blocks are merged in pairs,
/// and a division would be the slowest operation on a motion.
inline std::size_t block_of(std::uint64_t index, std::uint64_t length) {
  const bool is_power = (length & (length - 1)) == 0;
  return static_cast<std::size_t>(is_power ? index >> std::countr_zero(length) : index / length);
}

}  // namespace egocal::detail
