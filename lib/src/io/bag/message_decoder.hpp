// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

#include "io/bytes/byte_source.hpp"

namespace egocal::detail {

/// Reads the fields of one ROS message in order: ROS 1 serialisation (packed, little-endian) or CDR (ROS 2;
/// aligned, either byte order, recognised by its first four bytes). Reading past the end gives zeros and is
/// remembered: check ok() after reading.
class MessageDecoder {
 public:
  /// encoding: "ros1" or "cdr"; anything else is not ok.
  MessageDecoder(std::string_view encoding, ByteSpan data) : data_(data) {
    if (encoding == "ros1") return;
    // CDR and CDR2, plain, in both byte orders; CDR2 aligns to four bytes at most
    const unsigned kind = data.size() >= 4 ? data[1] : 0xff;
    ok_ = encoding == "cdr" && data.size() >= 4 && data[0] == 0 &&
          (kind <= 1 || kind == 6 || kind == 7 || kind == 0x10 || kind == 0x11);
    big_endian_ = kind % 2 == 0;
    largest_alignment_ = kind <= 1 ? 8 : 4;
    cdr_ = true;
    if (ok_) data_ = data.subspan(4);
  }

  bool ros1() const { return !cdr_; }
  std::uint32_t u32() { return static_cast<std::uint32_t>(bits(4)); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  double f64() { return std::bit_cast<double>(bits(8)); }
  std::string_view text() {
    const std::uint32_t size = u32();
    if (!has(size)) return {};
    std::string_view value(reinterpret_cast<const char*>(data_.data() + at_), size);
    at_ += size;
    if (cdr_ && !value.empty() && value.back() == '\0') value.remove_suffix(1);
    return value;
  }

  bool ok() const { return ok_; }
  std::size_t left() const { return ok_ ? data_.size() - at_ : 0; }

 private:
  bool has(std::size_t size) {
    ok_ = ok_ && size <= data_.size() - at_;
    return ok_;
  }
  std::uint64_t bits(std::size_t size) {
    if (cdr_) {
      const std::size_t alignment = size < largest_alignment_ ? size : largest_alignment_;
      const std::size_t padding = (alignment - at_ % alignment) % alignment;
      if (!has(padding)) return 0;
      at_ += padding;
    }
    if (!has(size)) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | data_[at_ + (big_endian_ ? i : size - 1 - i)];
    at_ += size;
    return value;
  }

  ByteSpan data_;
  std::size_t at_ = 0, largest_alignment_ = 1;
  bool cdr_ = false, big_endian_ = false, ok_ = true;
};

}  // namespace egocal::detail
