// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig/unusable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace egocal::tools {

namespace {

bool is_one_of(std::size_t sensor, const std::array<std::size_t, 3>& sensors) {
  return std::find(sensors.begin(), sensors.end(), sensor) != sensors.end();
}

/// Whether a finding that makes some pair bad is why this one should not be used. Most are of the pairs that
/// show them; a mount that moved has every pair of its sensor.
bool bears_on(const RigReport& report, const RigFinding& finding, std::size_t pair) {
  const RigPairAnswer& answer = report.solution.pairs[pair];
  if (finding.code == "mount_moved" && finding.sensor)
    return answer.a == *finding.sensor || answer.b == *finding.sensor;
  return std::find(finding.pairs.begin(), finding.pairs.end(), pair) != finding.pairs.end();
}

/// Whether an open loop is why this pair should not be used: it is a pair of the loop, and one of the sensor
/// to blame where that sensor is in the loop.
bool bears_on(const RigReport& report, const Loop& loop, std::size_t pair) {
  const RigPairAnswer& answer = report.solution.pairs[pair];
  if (!is_one_of(answer.a, loop.sensors) || !is_one_of(answer.b, loop.sensors)) return false;
  const bool one_is_blamed = report.blamed && is_one_of(*report.blamed, loop.sensors);
  return !one_is_blamed || answer.a == *report.blamed || answer.b == *report.blamed;
}

}  // namespace

bool is_open(const Loop& loop) {
  return loop.known > 0 && !loop.closed;
}

std::string why_unusable(const RigReport& report, const std::vector<RigFinding>& bad, std::size_t pair) {
  for (const RigFinding& finding : bad)
    if (bears_on(report, finding, pair)) return finding.message;
  if (report.pairs[pair].verdict == Verdict::contradictory) return report.pairs[pair].reason;
  for (const Loop& loop : report.solution.loops)
    if (is_open(loop) && bears_on(report, loop, pair))
      return fmt::format("The loop {} -> {} -> {} does not close.", report.names[loop.sensors[0]],
                         report.names[loop.sensors[1]], report.names[loop.sensors[2]]);
  return {};
}

}  // namespace egocal::tools
