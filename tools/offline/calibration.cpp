// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <system_error>
#include <utility>
#include <vector>

#include "arguments.hpp"
#include "egocal/baselines/baselines.hpp"
#include "egocal/calibrate_beside.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/error.hpp"
#include "egocal/io/misplaced_times.hpp"
#include "egocal/io/pairs_file.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "offline/answer_or_warn.hpp"
#include "offline/append.hpp"
#include "offline/beside.hpp"
#include "offline/log_trajectory.hpp"
#include "offline/median.hpp"
#include "offline/mounts_of_drives.hpp"
#include "offline/remedies.hpp"
#include "offline/samples.hpp"
#include "offline/scale_report.hpp"
#include "offline/trajectory_source.hpp"
#include "offline/with_nominal_part.hpp"

namespace egocal::tools {

namespace {

/// The motions as they were read.
struct Motions {
  Trajectory a, b;  ///< from trajectories or a log
  bool a_has_scale = true, b_has_scale = true;
  std::vector<MotionPair> pairs;  ///< from a file of pairs
  std::vector<std::string> warnings;
};

StreamSpan span_of(const Trajectory& trajectory) {
  return {trajectory.size(), to_seconds(trajectory.front().time_us), to_seconds(trajectory.back().time_us)};
}

/// A file that can be read beside another one, and is long enough to be worth a thread. Two pipes may be one.
bool is_long_file(const std::string& name) {
  constexpr std::uintmax_t least = 1 << 20;  // [bytes], read in some milliseconds
  std::error_code none;
  const std::filesystem::path file = parse_recording_name(name).file;
  return std::filesystem::is_regular_file(file, none) && std::filesystem::file_size(file, none) >= least;
}

/// A file of times was given for both.
bool has_common_times(const MotionSource& source) {
  return !source.reading_a.times_file.empty() && source.reading_a.times_file == source.reading_b.times_file;
}

Motions read_both(const MotionSource& source) {
  Motions motions;
  std::vector<std::string> warnings_b;
  const auto read_a = [&] {
    motions.a = read_noting(source.a, source.reading_a, motions.warnings, &motions.a_has_scale);
  };
  const auto read_b = [&] {
    motions.b = read_noting(source.b, source.reading_b, warnings_b, &motions.b_has_scale);
  };
  const bool are_long = is_long_file(source.a) && is_long_file(source.b);
  try {
    (are_long ? at_the_same_time : one_after_the_other)(read_a, read_b);
  } catch (const MisplacedTimes& error) {
    if (!has_common_times(source)) throw;
    throw Error(std::string(error.what()) + "; --times-a or --times-b gives the times of one file alone");
  }
  motions.warnings.insert(motions.warnings.end(), warnings_b.begin(), warnings_b.end());
  return motions;
}

Motions read_motions(const MotionSource& source) {
  Motions motions;
  if (!source.pairs.empty()) {
    motions.pairs = read_pairs(source.pairs);
    return motions;
  }
  if (source.log.empty()) return read_both(source);
  LogTrajectory a, b;
  (is_long_file(source.log) ? at_the_same_time : one_after_the_other)(
      [&] { a = read_log_trajectory(source.log, source.a); },
      [&] { b = read_log_trajectory(source.log, source.b); });
  motions.a = std::move(a.poses);
  motions.b = std::move(b.poses);
  // damage is of both
  for (std::string* warning : {&a.not_used, &b.not_used, &a.times, &b.times, &a.damage})
    if (!warning->empty()) motions.warnings.push_back(std::move(*warning));
  return motions;
}

/// Further drives, each after the ones before it.
Drives append_drives(const SolveRequest& request, Motions& motions) {
  Drives drives({&motions.a, &motions.b}, {request.source.a, request.source.b});
  if (request.append.empty()) return drives;
  if (!request.source.pairs.empty()) throw UsageError("--append: goes with two trajectories");
  if (request.append.size() % 2 != 0) throw UsageError("--append: expected a file for A and one for B");
  // columns and rate are those of the first drive; a file of times belongs to one drive
  ReadOptions a = request.source.reading_a, b = request.source.reading_b;
  a.times_file.clear();
  b.times_file.clear();
  for (std::size_t i = 0; i < request.append.size(); i += 2) {
    const std::string &name_a = request.append[i], &name_b = request.append[i + 1];
    drives.append({read_noting(name_a, a, motions.warnings), read_noting(name_b, b, motions.warnings)},
                  {name_a, name_b}, motions.warnings);
  }
  return drives;
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

using Clock = std::chrono::steady_clock;

/// The median of a duration that is measured again and again, for a tenth of a second or at least five times.
double median_us(const std::function<double()>& measure_us) {
  std::vector<double> times;
  const auto begin = Clock::now();
  while (times.size() < 5 || (times.size() < 201 && Clock::now() - begin < std::chrono::milliseconds(100)))
    times.push_back(measure_us());
  return median_of(std::move(times));
}

/// Of the solver, as it answered: without proof and observability.
double time_of_method(Method method, const Problem& problem) {
  const NanosecondClock clock = [] {
    return static_cast<std::int64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count());
  };
  return median_us(
      [&] { return 1e-3 * static_cast<double>(solve(problem, method, std::nullopt, clock).solve_ns); });
}

/// The motions that the answer was made from: as their poses were read, with their scale.
Motions as_solved(Motions motions, const CalibrationOptions& options, const SolveResult& result) {
  const Side side = options.scale_side;
  const double scale = result.calibration.scale_applied;
  if (!motions.pairs.empty()) {
    for (MotionPair& pair : motions.pairs) {
      DualQuaternion& motion = side == Side::a ? pair.a : pair.b;
      motion = scaled(motion, scale);
    }
    return motions;
  }
  motions.a = reread(motions.a, options.read_a);
  motions.b = reread(motions.b, options.read_b);
  Trajectory& stream = side == Side::a ? motions.a : motions.b;
  stream = result.course ? scaled(stream, *result.course) : scaled(stream, scale);
  return motions;
}

/// How as_solved() motions were paired, and b on the clock of a.
struct Paired {
  PairingOptions options;
  Trajectory b;
};

Paired as_paired(const Motions& motions, const CalibrationOptions& options, const Calibration& calibration) {
  Paired paired{options.pairing, motions.b};
  const std::optional<TimeOffset>& offset = calibration.time_offset;
  if (offset)
    paired.b = on_clock_of_a(*offset, motions.b);
  else
    paired.options.time_offset = calibration.time_offset_applied;
  paired.options.stride = calibration.choice.stride;
  paired.options.balance = calibration.choice.balance;
  return paired;
}

/// The motion pairs of the stride and the weights that were chosen, from the beginning of the drive. motions:
/// as_solved().
std::vector<MotionPair> pairs_of(const Motions& motions, const CalibrationOptions& options,
                                 const Calibration& calibration) {
  if (!motions.pairs.empty()) return motions.pairs;
  const Paired paired = as_paired(motions, options, calibration);
  return pair_motions(paired.options, motions.a, paired.b).pairs;
}

/// Median distance of two poses [s].
double period_of(const Trajectory& trajectory) {
  std::vector<double> steps;
  steps.reserve(trajectory.size());
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    steps.push_back(to_seconds(trajectory[i].time_us - trajectory[i - 1].time_us));
  return median_of(std::move(steps));
}

/// Motions as long as those that the fit is stated of, wrong ones included. motions: as_solved().
std::vector<MotionPair> pairs_of_fit(const Motions& motions, const CalibrationOptions& options,
                                     const Calibration& calibration) {
  if (!motions.pairs.empty()) return motions.pairs;
  Paired paired = as_paired(motions, options, calibration);
  const double period = std::max(period_of(motions.a), period_of(motions.b));
  const double steps = period > 0 ? std::round(calibration.fit.motion_seconds / period) : 1;
  paired.options.stride = static_cast<int>(std::clamp(steps, limits::stride.least, limits::stride.most));
  paired.options.robust = false;
  return pair_motions(paired.options, motions.a, paired.b).pairs;
}

/// Puts the answer of one of the paper's baselines in the place of ours. They minimise other things: our
/// certificate shows what their answer is worth.
void answer_by_baseline(const std::string& method, const std::vector<MotionPair>& pairs,
                        SolveResult& result) {
  const auto run = [&] {
    if (method == "analytic") return solve_analytic(pairs);
    if (method == "matrix") return solve_matrix(pairs);
    return solve_local(pairs);
  };
  const BaselineAnswer baseline = run();
  const DualQuaternion q = canonical_sign(normalized(baseline.T_a_b));
  Calibration& calibration = result.calibration;
  calibration.T_a_b = to_pose(q);
  calibration.T_b_a = inverse(calibration.T_a_b);
  calibration.problem.prior.reset();  // the baselines know none
  calibration.certificate = verify(cost_matrix(calibration.problem), q);
  result.note = baseline.valid ? "" : baseline.note;
  result.solve_us = median_us([&] {
    const auto start = Clock::now();
    run();
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  });
}

/// Where the scale that was estimated changes along the drive: one extrinsic for all of its segments.
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

void answer_sensors(const SolveRequest& request, SolveResult& result) {
  const std::optional<Method> method = method_from_name(request.method);
  if (!method && request.calibration.pairing.mode == Mode::planar)
    throw UsageError("--method " + request.method + ": has no planar mode");
  CalibrationOptions options = request.calibration;
  options.method = method.value_or(Method::dual);
  Motions motions = read_motions(request.source);
  result.warnings = motions.warnings;  // where the further drives cannot be read, too
  const Drives drives = append_drives(request, motions);
  result.warnings = motions.warnings;
  result.scale_side = options.scale_side;
  result.a_has_scale = motions.a_has_scale;
  result.b_has_scale = motions.b_has_scale;
  if (request.samples) {
    answer_samples(request, motions.a, motions.b, result);
    word_for_options_of_samples(options, request.scale_option, request.samples->eye_to_hand,
                                result.calibration);
    result.solve_us = time_of_method(Method::dual, result.calibration.problem);
    return;
  }
  if (look_like_samples(motions.a, motions.b))
    result.warnings.push_back("these look like still poses of an arm rather than streams: try " +
                              request.solve + "--samples");
  options.diagnosis.unit = unit_of_answer(request, result);
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
  for (Finding& finding : result.calibration.findings) {
    finding.remedy = remedy_in_terms(finding, terms);
    // a slow change has no one time
    if (!finding.time || finding.change == MountingChange::slowly) continue;
    const std::string place = drives.place_of(*finding.time);
    if (place.empty()) continue;
    const std::string said = fmt::format("{} {:.1f} s is {}.", finding.message, *finding.time, place);
    if (result.calibration.reason == finding.message) result.calibration.reason = said;
    finding.message = said;
  }
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
