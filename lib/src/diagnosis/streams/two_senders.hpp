// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses of two odometries in one stream, each with an origin of its own: two publishers on one topic.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// Study: tests/lib/test_two_senders.cpp, and seven simulated drives of three machines and two terrains of 30
/// to 140 s with a second odometry whose origin is 5 m and any heading away.
struct TwoSendersOptions {
  std::size_t most = 4000;  ///< rows that are looked at, in one run from the middle, for time
  std::size_t least = 20;   ///< rows aside: fewer may be so by chance
  /// A row is aside where it is this many times as far from the middle of its neighbours as these are from
  /// each other. On any smooth path it is a small part, and half of it on one that turns back.
  double aside = 2;
  double least_share = 0.1;  ///< of the rows; below, pairing omits the poses as outliers
  /// Rows aside go on from the last one on that side: their distance from the middle of their neighbours
  /// changes by less than this part of it. Of errors by chance it changes by all of it.
  double most_change = 0.25;
  /// Least part of the rows aside that go on so: 0.5 by chance in a narrow place, all of them for a second
  /// odometry.
  double least_going_on = 0.8;
  /// Rows aside travel at least this part of what the rows beside them travel: a pose that stands still is no
  /// second odometry, but a value of its own for no pose.
  double least_travel = 0.25;
  /// A row is further aside than this many times what the other sensor travels in two rows: what shakes as
  /// fast as it is measured shakes both.
  double beyond_other = 2;
};

/// The rows of one stream jump to another path and back, again and again, and that path goes on as well.
/// Nothing is then known of the answer: single rows are of another origin. Finding mixed_frames_a or
/// mixed_frames_b, certain. side: of which stream the poses are. metres: what lengths are in.
std::optional<Finding> two_senders(Side side, const Trajectory& own, const Trajectory& other, bool metres,
                                   const TwoSendersOptions& options = {});

}  // namespace egocal::detail
