// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "egocal/pairing/trajectory.hpp"

namespace egocal::tools {

/// When a recording is interrupted for so long that a figure leaves the time between out.
struct DrawnTimeOptions {
  double least_seconds = 30;  ///< far longer than any motion; shorter gaps are to be seen as such [s]
  double least_periods = 20;  ///< and than the median time between poses: slow streams have no breaks
};

/// The time axis of the figures: seconds since the first pose, without the breaks between drives that were
/// appended (an hour each) or in a recording.
class DrawnTime {
 public:
  /// a: the stream from whose first pose time is counted. Where it has no poses, time is counted from
  /// origin_us, without a break.
  explicit DrawnTime(const Trajectory& a, std::int64_t origin_us = 0, const DrawnTimeOptions& options = {});

  /// The place of a time on the axis [s]. A time within a break is where the break is.
  double seconds(std::int64_t time_us) const;
  /// The part of the recording that a time belongs to: how many breaks have their middle before it. Of
  /// another stream than a the poses of a part begin and end a little earlier or later.
  std::size_t part_of(std::int64_t time_us) const;
  /// Where breaks are on the axis [s].
  const std::vector<double>& breaks() const { return places_; }

 private:
  struct Break {
    std::int64_t begin_us, end_us;
  };
  std::int64_t origin_us_;
  std::vector<Break> breaks_;
  std::vector<double> places_;
};

}  // namespace egocal::tools
