// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace egocal::bus {

using Bytes = std::span<const std::byte>;

/// The unsigned number at a place, most significant byte first, as LCM writes all of its numbers. There are
/// as many bytes.
template <class Number>
Number big_endian(Bytes bytes, std::size_t at = 0) {
  Number value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    value = static_cast<Number>(value << 8 | std::to_integer<Number>(bytes[at + i]));
  return value;
}

}  // namespace egocal::bus
