// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/drives/mounts_of_drives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "egocal/degrees.hpp"
#include "egocal/error.hpp"
#include "offline/drives/fault_of_drive.hpp"

namespace egocal::tools {

namespace {

/// What a drive answers by itself; empty where it has no answer of its own.
std::optional<Calibration> of_drive(const Trajectory& a, const Trajectory& b,
                                    const CalibrationOptions& options) {
  try {
    return calibrate(a, b, options);
  } catch (const Error&) {
    return std::nullopt;  // the drives together have their answer
  }
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

/// Whether two drives differ by more than odometry errs otherwise on another road
/// (MovesOptions::least_rotation).
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
  if (shown.turn > 0) text = fmt::format("{:.2f} deg", degrees_per_radian * shown.turn);
  if (shown.shift > 0) text += fmt::format("{}{:.1f} cm", text.empty() ? "" : " and ", 100 * shown.shift);
  return text;
}

MountsDiffer worded(const Drives& drives, MountsDiffer differ) {
  Finding& finding = differ.finding;
  finding.code = "mount_moved";
  finding.certain = true;
  finding.message = fmt::format("The mounts of drive {} ({}) and drive {} ({}) differ by {}.",
                                differ.first + 1, drives.name(differ.first), differ.second + 1,
                                drives.name(differ.second), size_of(differ.shown));
  finding.remedy = "Calibrate them separately: a mount was moved between these drives.";
  finding.change = MountingChange::at_once;
  return differ;
}

/// Compares each drive that is usable by itself with the usable one before it.
std::vector<MountsDiffer> compared(const Drives& drives, const std::vector<std::optional<Calibration>>& alone,
                                   bool metres, const MountsOfDrivesOptions& mounts) {
  std::vector<MountsDiffer> found;
  std::optional<std::size_t> last;
  for (std::size_t k = 0; k < alone.size(); ++k) {
    if (!is_usable(alone[k])) continue;
    if (last)
      if (const Move move = difference(*alone[*last], *alone[k], metres); shows(move, mounts))
        found.push_back(worded(drives, {*last, k, shown_change(move), {}}));
    last = k;
  }
  return found;
}

/// The faults of drives that are not usable, where others are.
struct Faults {
  std::vector<Finding> findings;
  bool all_named = true;  ///< each such drive has one
  bool contradictory = false;
};

Faults faults_of(const Drives& drives, const std::vector<std::optional<Calibration>>& alone) {
  Faults faults;
  const bool others = std::any_of(alone.begin(), alone.end(), is_usable);
  for (std::size_t k = 0; k < alone.size(); ++k) {
    if (is_usable(alone[k])) continue;
    std::optional<Finding> fault;
    if (others && alone[k]) fault = fault_of_drive(drives, k, *alone[k]);
    faults.all_named = faults.all_named && fault;
    if (!fault) continue;
    faults.findings.push_back(std::move(*fault));
    faults.contradictory = faults.contradictory || alone[k]->verdict == Verdict::contradictory;
  }
  return faults;
}

/// Whether a drive that has no fault of its own shows a finding of this code.
bool is_shown_by(const std::vector<std::optional<Calibration>>& alone, const Finding& wanted) {
  return std::any_of(alone.begin(), alone.end(), [&](const std::optional<Calibration>& one) {
    return is_usable(one) && std::any_of(one->findings.begin(), one->findings.end(),
                                         [&](const Finding& finding) { return finding.code == wanted.code; });
  });
}

bool is_tolerated(const MountsDiffer& two, const DiagnosisOptions& options) {
  return two.shown.turn <= options.tolerance_rotation && two.shown.shift <= options.tolerance_translation;
}

/// What only single drives show. Slow changes of each drive cancel in the answer to all of them, or are small
/// against what an hour between them allows.
std::vector<MountsDiffer> name_what_single_drives_show(const Drives& drives,
                                                       const std::vector<std::optional<Calibration>>& alone,
                                                       std::vector<MountsDiffer> differ,
                                                       const DiagnosisOptions& options,
                                                       Calibration& calibration) {
  std::vector<Finding> findings;
  const auto is_about = [&](Verdict verdict, const std::string& reason) {
    if (verdict <= calibration.verdict) return;
    calibration.verdict = verdict;
    calibration.reason = reason;
  };
  for (std::size_t k = 0; k < alone.size(); ++k) {
    if (!alone[k] || is_usable(alone[k])) continue;
    OwnFault fault = own_fault_of_drive(drives, k, *alone[k]);
    is_about(alone[k]->verdict, fault.reason);
    if (fault.finding) findings.push_back(*std::move(fault.finding));
  }
  std::erase_if(differ, [&](const MountsDiffer& two) { return is_tolerated(two, options); });
  for (const MountsDiffer& two : differ) {
    is_about(Verdict::contradictory, two.finding.message);
    findings.push_back(two.finding);
  }
  calibration.findings.insert(calibration.findings.begin(), findings.begin(), findings.end());
  return differ;
}

}  // namespace

std::vector<MountsDiffer> name_what_drives_differ_in(const Drives& drives, std::size_t sensor_a,
                                                     std::size_t sensor_b, const Trajectory& a,
                                                     const Trajectory& b, const CalibrationOptions& options,
                                                     Calibration& calibration,
                                                     const MountsOfDrivesOptions& mounts) {
  if (drives.size() < 2) return {};
  const double scale = calibration.scale ? calibration.scale->scale : 1;
  const bool metres = unit_of_scaled(options.diagnosis.unit, scale) == LengthUnit::metres;
  std::vector<std::optional<Calibration>> alone(drives.size());
  for (std::size_t k = 0; k < drives.size(); ++k)
    alone[k] = of_drive(drives.part(a, k, sensor_a), drives.part(b, k, sensor_b), options);
  std::vector<MountsDiffer> differ = compared(drives, alone, metres, mounts);
  if (calibration.verdict < Verdict::doubtful)
    return name_what_single_drives_show(drives, alone, std::move(differ), options.diagnosis, calibration);
  Faults faults = faults_of(drives, alone);
  if (differ.empty() && faults.findings.empty()) return {};
  std::vector<Finding> findings = std::move(faults.findings);
  // a fault of one drive is in the answer to all of them
  bool contradictory = faults.contradictory;
  for (const MountsDiffer& two : differ) {
    findings.push_back(two.finding);
    contradictory = contradictory || !is_tolerated(two, options.diagnosis);
  }
  if (contradictory) calibration.verdict = Verdict::contradictory;
  // a drive without a fault that has a name may have one that all drives together show
  if (faults.all_named || contradictory) calibration.reason = findings.front().message;
  for (Finding& finding : calibration.findings)
    if (!faults.all_named || is_shown_by(alone, finding)) findings.push_back(std::move(finding));
  calibration.findings = std::move(findings);
  return differ;
}

}  // namespace egocal::tools
