// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include "io/bytes/byte_source.hpp"

namespace egocal::detail {

/// Reads numbers and strings of fixed layout from bytes, little-endian. Reading past the end gives zeros and
/// is remembered: check ok() once, after reading.
class LittleEndian {
 public:
  explicit LittleEndian(ByteSpan bytes) : bytes_(bytes) {}

  template <class Unsigned>
  Unsigned number() {
    std::uint64_t value = 0;
    const ByteSpan from = take(sizeof(Unsigned));
    for (std::size_t i = from.size(); i-- > 0;) value = value << 8 | from[i];
    return static_cast<Unsigned>(value);
  }
  std::uint8_t u8() { return number<std::uint8_t>(); }
  std::uint16_t u16() { return number<std::uint16_t>(); }
  std::uint32_t u32() { return number<std::uint32_t>(); }
  std::uint64_t u64() { return number<std::uint64_t>(); }

  /// A 32-bit length, then that many characters.
  std::string_view text() {
    const ByteSpan from = take(u32());
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  ByteSpan take(std::uint64_t size) {
    if (size > bytes_.size()) {
      ok_ = false;
      bytes_ = {};
      return {};
    }
    const ByteSpan taken = bytes_.first(static_cast<std::size_t>(size));
    bytes_ = bytes_.subspan(static_cast<std::size_t>(size));
    return taken;
  }

  std::size_t left() const { return bytes_.size(); }
  bool ok() const { return ok_; }
  /// Whether everything was read, and nothing beyond.
  bool complete() const { return ok_ && bytes_.empty(); }

 private:
  ByteSpan bytes_;
  bool ok_ = true;
};

}  // namespace egocal::detail
