// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace egocal::detail {

/// index / length: the block that an instant is in. Lengths are powers of two, as blocks are merged two by
/// two, and a division is the slowest thing that is done to a motion.
inline std::size_t block_of(std::uint64_t index, std::uint64_t length) {
  const bool is_power = (length & (length - 1)) == 0;
  return static_cast<std::size_t>(is_power ? index >> std::countr_zero(length) : index / length);
}

}  // namespace egocal::detail
