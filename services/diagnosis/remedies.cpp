// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/remedies.hpp"

#include <cstdio>
#include <optional>

namespace egocal::services {

namespace {

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

/// One of the two sensors has the wrong unit; the motions do not show which one.
std::string scale_remedy(const bus::Rig& rig, const bus::PairConfig& pair, double factor) {
  return "In the rig file: scale = " + number(factor * bus::sensor(rig, pair.b).scale) + " for " + pair.b +
         ", or scale = " + number(bus::sensor(rig, pair.a).scale / factor) + " for " + pair.a +
         " if that one is not in metres.";
}

/// A change of the scale can only be found live for a sensor with scale = "auto".
std::string or_its_scale(const bus::Rig& rig, const bus::PairConfig& pair) {
  const std::optional<Side> unscaled = bus::unscaled_side(rig, pair);
  if (!unscaled) return {};
  return " Or the scale of " + (*unscaled == Side::a ? pair.a : pair.b) +
         " changed, which egocal solve --scale-" + (*unscaled == Side::a ? "a" : "b") +
         " auto finds in a recording.";
}

std::string remedy_of(const bus::Rig& rig, const bus::PairConfig& pair, const Finding& finding) {
  const std::string& code = finding.code;
  const std::string both = pair.a + " and " + pair.b;
  const auto one = [&] { return code.ends_with("_a") ? pair.a : code.ends_with("_b") ? pair.b : both; };
  if ((code == "scale" || code == "units") && finding.value && *finding.value > 0)
    return scale_remedy(rig, pair, *finding.value);
  if (code == "clock_offset") return "In the rig file: time_offset = \"auto\" for this pair.";
  if (code == "clock_step" && !pair.time_offset)
    return "Do not set clocks during a drive: the new one is followed half a minute or more later. Reset the "
           "pair (key r in the monitor).";
  if (code == "clock_step")
    return "Do not set clocks during a drive; time_offset = \"auto\" in the rig file follows them. Reset the "
           "pair (key r in the monitor).";
  if (code == "clock_drift")
    return "Synchronise the clocks; until then time_offset = \"auto\" in the rig file follows them.";
  if (code.starts_with("inverted_"))
    return finding.certain ? "The odometry of " + one() +
                                 " has to send the inverse: poses of the sensor in its start frame."
                           : "Make sure that the odometry sends poses of the sensor in its start frame.";
  if (code.starts_with("quaternion_order_"))
    return "The odometry of " + one() + " has to fill quat in the order w x y z." +
           (finding.remedy.find("--invert-") != std::string::npos
                ? " It also has to send the inverse: poses of the sensor in its start frame."
                : "");
  if (code == "scale_change" && finding.time)
    return "Live, a session has one scale: reset the pair (key r in the monitor) after it has changed. In a "
           "recording egocal solve --scale-b auto finds the factors, --scale auto where " +
           pair.b + " is in metres.";
  // a creeping mount goes on creeping after a reset, so the remedy is that of a recording
  if (code == "mount_moved" && finding.change == MountingChange::slowly)
    return finding.remedy + or_its_scale(rig, pair);
  if (code == "mount_moved")
    return (pair.on_move == bus::OnMove::restart
                ? "The calibration starts again by itself."
                : "Reset the pair (key r in the monitor), or set on_move = \"restart\" in the rig file.") +
           or_its_scale(rig, pair);
  return finding.remedy;
}

}  // namespace

void word_remedies(const bus::Rig& rig, const bus::PairConfig& pair, std::vector<Finding>& findings) {
  for (Finding& finding : findings) finding.remedy = remedy_of(rig, pair, finding);
}

}  // namespace egocal::services
