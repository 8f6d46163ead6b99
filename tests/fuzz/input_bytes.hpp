// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace egocal::fuzz {

/// The fuzzer's bytes as choices; zeros after the end.
class InputBytes {
 public:
  InputBytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool done() const { return at_ >= size_; }
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
  std::int8_t step() { return static_cast<std::int8_t>(byte()); }
  std::int64_t number() {
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i) value = value << 8 | byte();
    return static_cast<std::int64_t>(value);
  }
  /// Near the one before, mostly; anything now and then.
  std::int64_t near(std::int64_t before, std::int64_t unit) {
    const std::uint8_t choice = byte();
    // near the ends of the range the sum wraps round, as a hostile sender's would
    const auto moved = [&](std::int64_t steps) {
      return static_cast<std::int64_t>(static_cast<std::uint64_t>(before) +
                                       static_cast<std::uint64_t>(unit) * static_cast<std::uint64_t>(steps));
    };
    if (choice < 160) return moved(1);
    if (choice < 220) return moved(step());
    if (choice < 240)
      return static_cast<std::int64_t>(static_cast<std::uint64_t>(before) ^ 1ULL << (byte() & 63));
    return number();
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

}  // namespace egocal::fuzz
