// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "egocal/pairing/time_offset.hpp"

namespace egocal {

/// The search for a time offset in small pieces, so that it can be spread over the poses of a live stream.
/// The result depends on the trajectories and options alone, not on how the work is divided.
///
/// The angle that a rigid body turns by between two instants is the same for every sensor on it, whatever the
/// extrinsic: correlated over all offsets at which the streams overlap, it finds the offset of clocks that
/// share nothing. Then the certified minimum of the cost (18) as a function of offset and drift is minimised
/// over motions that are not outliers. Time and memory are bounded by the number of poses (n log n), never by
/// the span of their stamps.
class TimeOffsetSearch {
 public:
  /// Poses that are not valid, or whose stamps do not increase, are skipped.
  TimeOffsetSearch(const Trajectory& a, const Trajectory& b, const TimeOffsetOptions& options = {});
  ~TimeOffsetSearch();
  TimeOffsetSearch(TimeOffsetSearch&&) noexcept;
  TimeOffsetSearch& operator=(TimeOffsetSearch&&) noexcept;

  /// Does the next pieces of work, of about `work` poses together. Returns whether the search is finished.
  bool step(std::size_t work);
  /// Calls of step() that found something to do.
  std::size_t steps() const;
  bool finished() const;
  /// Does what is left. Empty where the streams are too short, never turn or do not match.
  std::optional<TimeOffset> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace egocal
