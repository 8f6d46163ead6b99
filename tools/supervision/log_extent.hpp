// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "egocal/bus/log_file.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::tools {

/// How many poses a stream has in any part of a drive: counted by tenths of a second, so that the memory does
/// not grow with its rate.
class PoseCounts {
 public:
  /// Counts a pose. Times ascend.
  void add(std::int64_t time_us);
  void clear() { *this = {}; }
  /// The number of poses after `from_us` and up to `to_us`; wrong by the poses of a tenth of a second at
  /// either end.
  std::int64_t between(std::int64_t from_us, std::int64_t to_us) const;
  /// The mean time between two poses, where the stream has no gap [s].
  double period() const { return steps_ > 0 ? to_seconds(stepped_us_ / steps_) : 0; }

 private:
  struct Tenth {
    std::int64_t number = 0, poses = 0;  ///< of the tenth, since 1970; in it and before it
  };
  std::int64_t until(std::int64_t time_us) const;
  std::vector<Tenth> tenths_;  ///< those that hold poses
  std::int64_t last_us_ = 0, steps_ = 0, stepped_us_ = 0;
};

/// From when to when a log holds poses of each sensor of a rig: what an answer of the whole log is about.
struct LogExtent {
  struct Stream {
    std::int64_t first_us = 0, last_us = 0;  ///< in the sensor's own time, in the log's order [us]
    PoseCounts poses;
    std::int64_t earlier_us = 0;  ///< on earlier timelines: its clock went back. All else is of the last one
    std::int64_t begin_us = 0;    ///< the first pose of all timelines, in the time of the first one [us]
    std::int64_t messages = 0;
    /// The longest time without a message, from the first pose of the rig to the last one, as recorded [us
    /// since that first pose].
    std::int64_t silent_from_us = 0, silent_until_us = 0;
  };
  std::map<std::string, Stream> sensors;           ///< by name; one whose channel holds no pose is missing
  std::map<std::string, std::int64_t> unreadable;  ///< messages of a sensor that hold no pose, by its name
  bus::LogDamage damage;
};

/// Reads the whole log, from its first event on.
LogExtent log_extent(bus::LogReader& log, const bus::Rig& rig);

}  // namespace egocal::tools
