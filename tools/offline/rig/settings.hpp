// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "offline/rig/calibration.hpp"

namespace egocal::tools {

/// A pair of the rig's sensors as it is calibrated: what is common to all, and what the rig file says of it.
struct RigPairSettings {
  std::size_t a = 0, b = 0;  ///< sensors, a < b
  CalibrationOptions calibration;
  std::optional<Pose> nominal_part;  ///< of which something is not known, as the file lists the pair
  bool turned = false;               ///< the file lists it as b, a
  std::optional<Pose> truth;         ///< T_a_b
  bool listed = false;               ///< by the rig file
  /// Added to the stamps of b where the file lists the pair [s]; empty: it is to be found.
  std::optional<double> time_offset = 0;
};

/// What is calibrated, and how. Sensors are those that have a source, in the order in which they were given.
struct RigSettings {
  std::vector<std::string> names, sources;
  std::vector<double> scales;       ///< of the lengths of each sensor
  std::vector<GroundPlane> planes;  ///< one a sensor where all pairs are planar; otherwise empty
  std::vector<RigPairSettings> pairs;
};

/// All pairs of the request's sensors, with the settings of its rig file where it names one. Throws Error
/// naming file, key and cure for what a recording cannot be solved with, UsageError where options contradict.
RigSettings rig_settings(const RigRequest& request);

}  // namespace egocal::tools
