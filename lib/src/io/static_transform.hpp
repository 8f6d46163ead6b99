// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "egocal/io/recording.hpp"

namespace egocal::detail {

/// The values of one static transform in the order of the recording. As in tf2 a value holds for all time,
/// and the newest one counts. Senders repeat it; a change is a contradiction.
class StaticTransform {
 public:
  StaticTransform() = default;
  explicit StaticTransform(const RecordedStream& stream) : stream_(stream) {}

  /// Takes a value of any static stream; values of other transforms are ignored.
  void add(const RecordedStream& stream, const StampedPose& value);
  /// The newest one. Empty: none was sent.
  const Trajectory& value() const { return newest_; }
  /// How often the value changes, when and by how much first, and which value is used; empty: it does not
  /// change.
  std::string contradiction() const;

 private:
  RecordedStream stream_;
  Trajectory newest_, elsewhere_;  ///< of the stream, and of the same frames on another topic; one or none
  std::string other_topic_;
  std::uint64_t changes_ = 0;
  std::string first_change_;
};

}  // namespace egocal::detail
