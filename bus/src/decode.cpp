// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/decode.hpp"

#include <cstdint>

namespace egocal::bus {

namespace {

/// Walks over the layout of an encoded message (big-endian, strings with length and final zero) without
/// reading more of it than the length fields.
class Walk {
 public:
  explicit Walk(Bytes bytes) : bytes_(bytes) { skip(8); }  // the fingerprint

  void skip(std::size_t size) {
    if (size > bytes_.size() - position_)
      fail();
    else
      position_ += size;
  }

  std::int32_t int32() {
    const std::size_t at = position_;
    skip(4);
    if (failed_) return 0;
    return static_cast<std::int32_t>(big_endian<std::uint32_t>(bytes_, at));
  }

  void string() {
    const std::int32_t length = int32();
    if (length < 1)
      fail();
    else
      skip(static_cast<std::size_t>(length));
  }

  /// A count whose elements take at least this many bytes each.
  std::size_t count(std::size_t least_size) {
    const std::int32_t n = int32();
    if (failed_ || n < 0 || static_cast<std::size_t>(n) > (bytes_.size() - position_) / least_size) {
      fail();
      return 0;
    }
    return static_cast<std::size_t>(n);
  }

  bool done() const { return !failed_ && position_ == bytes_.size(); }

 private:
  void fail() {
    failed_ = true;
    position_ = bytes_.size();
  }

  Bytes bytes_;
  std::size_t position_ = 0;
  bool failed_ = false;
};

constexpr std::size_t statistics_size = 8 + 8 + 36 * 8;                             // bytes, format
constexpr std::size_t scale_statistics_size = 8 + 8 + (10 + 16 + 16 + 10 + 2) * 8;  // bytes, format
constexpr std::size_t fit_size = 8 + 8 * 8;                                         // bytes, format
/// Bytes of a finding behind its strings, format. One more byte is between the strings.
constexpr std::size_t finding_numbers = 8 + 8 + 1 + 8 + 1 + 24 + 32;
constexpr std::size_t least_string = 4 + 1;  // bytes, format: length and final zero

}  // namespace

bool lengths_fit(const odometry_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(16 + 24 + 32);
  walk.skip(8 * walk.count(8));
  return walk.done();
}

bool lengths_fit(const bot_core::pose_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(8 + 24 + 24 + 32 + 24 + 24);
  return walk.done();
}

bool lengths_fit(const motion_pair_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(4 * 8 + 4 + 2 * 64 + 8 + 1);
  return walk.done();
}

bool lengths_fit(const problem_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(3 * 8);
  walk.string();
  walk.string();
  walk.skip(1 + 2 * 32 + 2 * 8 + 4);
  walk.string();
  walk.skip(statistics_size * walk.count(statistics_size));
  walk.skip(2 * (1 + 24 + 32) + 5 * 8);
  walk.string();
  walk.skip(8);
  return walk.done();
}

bool lengths_fit(const calibration_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(4 * 8);
  for (int i = 0; i < 4; ++i) walk.string();
  walk.skip(24 + 32 + 4 * 8 + 1 + 2 * 8 + 6 + 6 * 8);
  walk.string();
  walk.skip(1 + 3 * 8);
  return walk.done();
}

bool lengths_fit(const status_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(8);
  for (int i = 0; i < 3; ++i) walk.string();
  walk.skip(4 + 8);
  for (int i = 0; i < 3; ++i) walk.string();
  const std::size_t counters = walk.count(4 + 1 + 8);
  for (std::size_t i = 0; i < counters; ++i) {
    walk.string();
    walk.skip(8);
  }
  const std::size_t acknowledgements = walk.count(4 + 1 + 16);
  for (std::size_t i = 0; i < acknowledgements; ++i) {
    walk.string();
    walk.skip(16);
  }
  return walk.done();
}

bool lengths_fit(const command_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(8);
  for (int i = 0; i < 4; ++i) walk.string();
  walk.skip(8);
  return walk.done();
}

bool lengths_fit(const verdict_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(4 * 8);
  for (int i = 0; i < 5; ++i) walk.string();
  walk.skip(24 + 32 + 6 + 2 * 48 + 2 * 8 + fit_size);
  const std::size_t findings = walk.count(3 * least_string + 1 + finding_numbers);
  for (std::size_t i = 0; i < findings; ++i) {
    walk.string();
    walk.skip(1);
    walk.string();
    walk.string();
    walk.skip(finding_numbers);
  }
  walk.skip(2);
  walk.string();
  walk.skip(8);
  walk.string();
  return walk.done();
}

bool lengths_fit(const scale_problem_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(3 * 8);
  walk.string();
  walk.string();
  walk.skip(3 + 6 * 8);
  walk.skip(scale_statistics_size * walk.count(scale_statistics_size));
  return walk.done();
}

bool lengths_fit(const scale_t*, Bytes bytes) {
  Walk walk(bytes);
  walk.skip(3 * 8);
  for (int i = 0; i < 3; ++i) walk.string();
  walk.skip(1 + 9 * 8 + 3 + 8);
  return walk.done();
}

std::string type_name(Bytes bytes) {
  if (is_a<odometry_t>(bytes)) return "egocal.odometry_t";
  if (is_a<bot_core::pose_t>(bytes)) return "bot_core.pose_t";
  if (is_a<motion_pair_t>(bytes)) return "egocal.motion_pair_t";
  if (is_a<problem_t>(bytes)) return "egocal.problem_t";
  if (is_a<calibration_t>(bytes)) return "egocal.calibration_t";
  if (is_a<verdict_t>(bytes)) return "egocal.verdict_t";
  if (is_a<scale_problem_t>(bytes)) return "egocal.scale_problem_t";
  if (is_a<scale_t>(bytes)) return "egocal.scale_t";
  if (is_a<status_t>(bytes)) return "egocal.status_t";
  if (is_a<command_t>(bytes)) return "egocal.command_t";
  return "unknown type";
}

}  // namespace egocal::bus
