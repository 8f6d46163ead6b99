// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/pair/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "arguments.hpp"
#include "egocal/calibrate_beside.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/error.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "offline/common/answer_or_warn.hpp"
#include "offline/common/beside.hpp"
#include "offline/common/with_nominal_part.hpp"
#include "offline/drives/goal_of_drives.hpp"
#include "offline/drives/mounts_of_drives.hpp"
#include "offline/pair/as_solved.hpp"
#include "offline/pair/baseline_answer.hpp"
#include "offline/pair/motions.hpp"
#include "offline/pair/option_remedies.hpp"
#include "offline/pair/samples.hpp"
#include "offline/pair/solve_time.hpp"
#include "offline/pair/unit.hpp"

namespace egocal::tools {

namespace {

StreamSpan span_of(const Trajectory& trajectory) {
  return {trajectory.size(), to_seconds(trajectory.front().time_us), to_seconds(trajectory.back().time_us)};
}

Calibration calibrate_motions(const MotionSource& source, const Motions& motions,
                              const CalibrationOptions& options, const Terms& terms) {
  if (!source.pairs.empty()) return calibrate(motions.pairs, options);
  constexpr std::size_t least_poses = 1000;  // worth a thread: some milliseconds
  const bool is_long = std::min(motions.a.size(), motions.b.size()) >= least_poses;
  try {
    return calibrate(motions.a, motions.b, options, is_long ? Beside(at_the_same_time) : Beside());
  } catch (const AdvisedError& error) {
    throw Error(source.a + ", " + source.b + ": " + error.in_terms(terms));
  } catch (const Error& error) {
    throw Error(source.a + ", " + source.b + ": " + error.what());
  }
}

/// Finds one extrinsic for all segments of the drive, where the scale that was estimated changes along it.
void follow_scale(Motions& motions, CalibrationOptions options, SolveResult& result) {
  Calibration& calibration = result.calibration;
  if (!calibration.scale || motions.a.empty()) return;
  Trajectory a = reread(motions.a, options.read_a), b = reread(motions.b, options.read_b);
  if (calibration.time_offset) b = on_clock_of_a(*calibration.time_offset, std::move(b));
  const Side side = options.scale_side;
  const ScaleCourse course = find_scale_course(a, b, options.pairing, *calibration.scale, side);
  if (!course.changes()) return;
  (side == Side::a ? a : b) = scaled(side == Side::a ? a : b, course);
  options.read_a = options.read_b = {};
  options.diagnosis.unit = unit_of_scaled(options.diagnosis.unit, calibration.scale->scale);
  options.estimate_scale = options.estimate_time_offset = false;
  options.scale = 1;
  Calibration followed = calibrate(a, b, options);
  followed.scale = calibration.scale;
  followed.scale_applied = calibration.scale_applied;
  followed.time_offset = calibration.time_offset;
  followed.time_offset_applied = calibration.time_offset_applied;
  calibration = std::move(followed);
  result.course = course;
}

/// Words cures as the user gives them, and says where a time is in which of several drives.
void word_for_user(const Drives& drives, const Terms& terms, Calibration& calibration) {
  for (Finding& finding : calibration.findings) {
    finding.remedy = remedy_in_terms(finding, terms);
    // a slow change has no one time
    if (!finding.time || finding.change == MountingChange::slowly) continue;
    const std::string place = drives.place_of(*finding.time);
    if (place.empty()) continue;
    const std::string said = fmt::format("{} {:.1f} s is {}.", finding.message, *finding.time, place);
    if (calibration.reason == finding.message) calibration.reason = said;
    finding.message = said;
  }
}

void answer_sensors(const SolveRequest& request, SolveResult& result) {
  const std::optional<Method> method = method_from_name(request.method);
  if (!method && request.calibration.pairing.mode == Mode::planar)
    throw UsageError("--method " + request.method + ": has no planar mode");
  CalibrationOptions options = request.calibration;
  options.method = method.value_or(Method::dual);
  if (request.samples) {
    answer_samples(request, result);
    word_for_options_of_samples(options, request.scale_option, request.samples->eye_to_hand,
                                result.calibration);
    result.solve_us = time_of_method(Method::dual, result.calibration.problem);
    return;
  }
  Motions motions = read_motions(request.source);
  result.warnings = motions.warnings;  // where the further drives cannot be read, too
  const Drives drives = append_drives(request, motions);
  result.warnings = motions.warnings;
  result.scale_side = options.scale_side;
  result.a_has_scale = motions.a_has_scale;
  result.b_has_scale = motions.b_has_scale;
  if (look_like_samples(motions.a, motions.b))
    result.warnings.push_back("these look like still poses of an arm rather than streams: try " +
                              request.solve + "--samples");
  options.diagnosis.unit = unit_of_answer(request, result);
  if (options.estimate_time_offset)
    result.clocks = put_drives_on_clock_of_a(drives, 0, 1, motions.a, motions.b, options);
  if (!result.clocks.empty()) {
    options.estimate_time_offset = false;
    options.pairing.time_offset = 0;
  }
  Terms terms;
  terms.solve = request.solve;
  std::string note;
  result.calibration = with_nominal_part(
      request.nominal_part, NominalOf::b_in_a, options,
      [&](const CalibrationOptions& of_run) {
        return calibrate_motions(request.source, motions, of_run, terms);
      },
      note);
  if (!note.empty()) result.warnings.push_back("--nominal: " + note);
  follow_scale(motions, options, result);
  word_for_options(options, request.scale_option, result.calibration);
  if (std::string warning = scale_warning(request, result); !warning.empty())
    result.warnings.push_back(std::move(warning));
  name_what_drives_differ_in(drives, 0, 1, motions.a, motions.b, options, result.calibration);
  count_driving_only(drives, result.calibration);
  word_for_user(drives, terms, result.calibration);
  if (!motions.a.empty()) result.a = span_of(motions.a);
  if (!motions.b.empty()) result.b = span_of(motions.b);
  if (!request.append.empty()) {
    const Motions solved = as_solved(motions, options, result);
    const Paired paired = as_paired(solved, options, result.calibration);
    drives.require_motions(0, 1, solved.a, paired.b, paired.options);
  }
  if (request.keep_motions || !method) {
    motions = as_solved(std::move(motions), options, result);
    result.pairs = pairs_of(motions, options, result.calibration);
    if (request.keep_motions) result.fit_pairs = pairs_of_fit(motions, options, result.calibration);
    result.trajectory_a = std::move(motions.a);
    result.trajectory_b = std::move(motions.b);
  }
  if (!method) {
    result.method = request.method;
    answer_by_baseline(request.method, result.pairs, result);
    return;
  }
  const bool closed_form = options.pairing.mode == Mode::planar && *method != Method::slsqp;
  result.method = closed_form ? "planar" : std::string(to_string(*method));
  result.solve_us = time_of_method(*method, result.calibration.problem);
}

}  // namespace

SolveResult calibrate_offline(const SolveRequest& request) {
  return answer_or_warn(request, answer_sensors);
}

}  // namespace egocal::tools
