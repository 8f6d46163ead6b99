// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "egocal/bus/log_file.hpp"
#include "egocal/bus/rig.hpp"

namespace egocal::tools {

/// From when to when a log holds poses of each sensor of a rig: what an answer of the whole log is about.
struct LogExtent {
  struct Stream {
    std::int64_t first_us = 0, last_us = 0;  ///< in the sensor's own time, in the log's order [us]
  };
  std::map<std::string, Stream> sensors;  ///< by name; one whose channel holds no pose is missing
  bus::LogDamage damage;
};

/// Reads the whole log, from its first event on.
LogExtent log_extent(bus::LogReader& log, const bus::Rig& rig);

}  // namespace egocal::tools
