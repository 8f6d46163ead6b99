// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/mounts_of_drives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "degrees.hpp"
#include "egocal/error.hpp"
#include "egocal/moves/find_moves.hpp"

namespace egocal::tools {

namespace {

/// What each drive answers by itself; empty for a drive without an answer of its own.
std::vector<std::optional<Calibration>> each_alone(const Drives& drives, const Trajectory& a,
                                                   const Trajectory& b, const CalibrationOptions& options) {
  std::vector<std::optional<Calibration>> alone(drives.size());
  for (std::size_t k = 0; k < drives.size(); ++k) try {
      alone[k] = calibrate(drives.part(a, k, 0), drives.part(b, k, 1), options);
    } catch (const Error&) {
      alone[k].reset();  // the drives together have their answer
    }
  return alone;
}

bool is_usable(const std::optional<Calibration>& alone) {
  return alone && alone->verdict <= Verdict::incomplete;
}

/// The second drive's extrinsic against the first one's, in the frame of a. Lengths that are not metres have
/// no limit in metres, and may be in another unit in each drive: without `metres` no translation is known.
Move difference(const Calibration& first, const Calibration& second, bool metres) {
  Move move;
  move.before = to_dual_quaternion(first.T_a_b);
  move.after = to_dual_quaternion(second.T_a_b);
  const Eigen::Vector3d turned = rotation_log(second.T_a_b.rotation * first.T_a_b.rotation.conjugate()),
                        shifted = second.T_a_b.translation - first.T_a_b.translation;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto axis = static_cast<Eigen::Index>(i % 3);
    move.change[i] = i < 3 ? shifted[axis] : turned[axis];
    const bool known =
        (metres || i >= 3) && first.observability.observable[i] && second.observability.observable[i];
    move.stddev[i] = known ? std::hypot(first.observability.stddev[i], second.observability.stddev[i])
                           : std::numeric_limits<double>::infinity();
  }
  return move;
}

/// By more than odometry errs otherwise on another road (MovesOptions::least_rotation).
bool shows(const Move& move, const MountsOfDrivesOptions& mounts) {
  const MovesOptions options;
  for (std::size_t i = 0; i < 6; ++i) {
    const double least = i < 3 ? options.least_translation : options.least_rotation;
    if (std::abs(move.change[i]) > least + mounts.sigmas * move.stddev[i]) return true;
  }
  return false;
}

std::string size_of(const ShownChange& shown) {
  std::string text;
  if (shown.turn > 0) text = fmt::format("{:.2f} deg", degrees * shown.turn);
  if (shown.shift > 0) text += fmt::format("{}{:.1f} cm", text.empty() ? "" : " and ", 100 * shown.shift);
  return text;
}

Finding worded(const Drives& drives, std::size_t first, const ShownChange& shown) {
  Finding finding;
  finding.code = "mount_moved";
  finding.certain = true;
  finding.message = fmt::format("The mounts of drive {} ({}) and drive {} ({}) differ by {}.", first + 1,
                                drives.name(first), first + 2, drives.name(first + 1), size_of(shown));
  finding.remedy = "Calibrate them separately: a mount was moved between these drives.";
  finding.change = MountingChange::at_once;
  return finding;
}

bool is_shown_by(const std::vector<std::optional<Calibration>>& alone, const Finding& wanted) {
  return std::any_of(alone.begin(), alone.end(), [&](const std::optional<Calibration>& one) {
    return one && std::any_of(one->findings.begin(), one->findings.end(),
                              [&](const Finding& finding) { return finding.code == wanted.code; });
  });
}

}  // namespace

void name_mounts_of_drives(const Drives& drives, const Trajectory& a, const Trajectory& b,
                           const CalibrationOptions& options, Calibration& calibration,
                           const MountsOfDrivesOptions& mounts) {
  if (drives.size() < 2 || calibration.verdict < Verdict::doubtful) return;
  const double scale = calibration.scale ? calibration.scale->scale : 1;
  const bool metres = unit_of_scaled(options.diagnosis.unit, scale) == LengthUnit::metres;
  const std::vector<std::optional<Calibration>> alone = each_alone(drives, a, b, options);
  std::vector<Finding> findings;
  bool beyond_tolerance = false;
  for (std::size_t k = 0; k + 1 < drives.size(); ++k) {
    if (!is_usable(alone[k]) || !is_usable(alone[k + 1])) continue;
    const Move move = difference(*alone[k], *alone[k + 1], metres);
    if (!shows(move, mounts)) continue;
    const ShownChange shown = shown_change(move);
    findings.push_back(worded(drives, k, shown));
    beyond_tolerance = beyond_tolerance || shown.turn > options.diagnosis.tolerance_rotation ||
                       shown.shift > options.diagnosis.tolerance_translation;
  }
  if (findings.empty()) return;
  if (beyond_tolerance) calibration.verdict = Verdict::contradictory;
  // a drive that is not usable by itself may have a fault of its own, of which these say nothing
  const bool explains_all = std::all_of(alone.begin(), alone.end(), is_usable);
  if (explains_all || beyond_tolerance) calibration.reason = findings.front().message;
  for (Finding& finding : calibration.findings)
    if (!explains_all || is_shown_by(alone, finding)) findings.push_back(std::move(finding));
  calibration.findings = std::move(findings);
}

}  // namespace egocal::tools
