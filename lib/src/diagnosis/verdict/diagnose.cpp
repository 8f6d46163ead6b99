// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/diagnosis/diagnose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnosis/explanations/both_streams.hpp"
#include "diagnosis/explanations/contents/forward.hpp"
#include "diagnosis/explanations/lengths/lengths_in_turns.hpp"
#include "diagnosis/explanations/planes.hpp"
#include "diagnosis/explanations/replacing.hpp"
#include "diagnosis/explanations/times/clock_check.hpp"
#include "diagnosis/explanations/times/clock_step.hpp"
#include "diagnosis/explanations/times/early_rotations.hpp"
#include "diagnosis/explanations/times/held_stream.hpp"
#include "diagnosis/explanations/times/late_column.hpp"
#include "diagnosis/explanations/times/late_positions.hpp"
#include "diagnosis/explanations/times/late_rotations.hpp"
#include "diagnosis/explanations/times/late_turning.hpp"
#include "diagnosis/explanations/times/moved_answer.hpp"
#include "diagnosis/explanations/times/smoothed_rotations.hpp"
#include "diagnosis/explanations/turning/wandering_headings.hpp"
#include "diagnosis/motions/answer_change.hpp"
#include "diagnosis/motions/fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "diagnosis/streams/contradicting_runs.hpp"
#include "diagnosis/streams/interpolated_stream.hpp"
#include "diagnosis/streams/missing_in_both.hpp"
#include "diagnosis/streams/mixed_frames.hpp"
#include "diagnosis/streams/pace.hpp"
#include "diagnosis/streams/stamps_in_bursts.hpp"
#include "diagnosis/streams/turning_alike.hpp"
#include "diagnosis/streams/two_dimensions.hpp"
#include "diagnosis/verdict/besides.hpp"
#include "diagnosis/verdict/ends_of_lines.hpp"
#include "diagnosis/verdict/foreseen.hpp"
#include "diagnosis/verdict/judge.hpp"
#include "diagnosis/verdict/known_directions.hpp"
#include "diagnosis/verdict/look_further.hpp"
#include "diagnosis/verdict/same_stream.hpp"
#include "diagnosis/verdict/small_scale.hpp"
#include "diagnosis/verdict/timing.hpp"
#include "diagnosis/verdict/travel_in_noise.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"

namespace egocal {

namespace {

using namespace detail;

bool has(const std::vector<Finding>& findings, std::string_view code) {
  return std::any_of(findings.begin(), findings.end(),
                     [code](const Finding& one) { return one.code == code; });
}

/// One of the two streams is inverted; which one is open.
bool one_is_inverted(const std::vector<Finding>& findings, const DiagnosisOptions& options) {
  const auto named = [&](std::string_view code) {
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& one) {
      return one.code == code && one.improvement > std::exp(options.gain);
    });
  };
  return named("inverted_a") && named("inverted_b");
}

Fit fit_of(const Evidence& evidence, const Answered& answered, const DiagnosisOptions& options) {
  return fit_at(evidence.given.explained.motions, to_pose(answered.T_a_b),
                evidence.stride * evidence.instants.period, options.motions);
}

Diagnosis of_too_few_motions(const Evidence& evidence, const Answered& answered,
                             const DiagnosisOptions& options) {
  Diagnosis result = diagnose(answered, options);
  result.fit = fit_of(evidence, answered, options);
  result.findings.push_back(too_little_motion(evidence.given.explained.motions.all.size(), options));
  judge(result, answered, {}, options);
  return result;
}

/// What can be seen of the planes and of single poses, before anything is compared.
void add_faults_of_poses(const Evidence& evidence, const Answered& answered, const DiagnosisOptions& options,
                         std::vector<Finding>& findings) {
  const bool metres = options.unit == LengthUnit::metres;
  if (answered.problem.mode == Mode::planar)
    for (Finding& finding : check_planes(evidence.given.explained, answered.problem.plane_a,
                                         answered.problem.plane_b, metres, options.planes))
      findings.push_back(std::move(finding));
  // single steps show it; longer motions may all begin and end in one of the frames
  if (std::optional<Finding> mixed = mixed_frames(evidence.instants, to_pose(answered.T_a_b), metres)) {
    // two frames of one body also look like two odometries
    std::erase_if(findings, [&](const Finding& one) { return one.code == mixed->code; });
    findings.insert(findings.begin(), *std::move(mixed));
  }
}

/// A speed that no vehicle has, unless the streams are read otherwise: the pace is that of inverse poses
/// then.
void add_impossible_pace(const Evidence& evidence, const DiagnosisOptions& options,
                         std::vector<Finding>& findings) {
  const auto reads_otherwise = [](const Finding& one) {
    return one.certain && one.code.starts_with("inverted_");
  };
  if (std::any_of(findings.begin(), findings.end(), reads_otherwise)) return;
  const double period = evidence.instants.period;
  if (std::optional<Finding> pace =
          impossible_pace(evidence.given.explained.motions, evidence.stride * period, period,
                          options.unit == LengthUnit::metres, options.pace))
    findings.insert(findings.begin(), *std::move(pace));
}

/// Poses on lines between measured ones. What that leaves unknown counts as unknown.
void add_interpolated_streams(const Foreseen& foreseen, const DiagnosisOptions& options, Answered& answered,
                              Diagnosis& result) {
  const PairingOptions& pairing = foreseen.pairing;
  for (Finding& finding : interpolated_streams(foreseen.a, foreseen.b)) {
    if (pairing.mode != Mode::planar) {
      const Side side = finding.code.ends_with("_a") ? Side::a : Side::b;
      const std::array<double, 6> lost =
          lost_on_lines(foreseen.evidence, side, pairing.max_gap, answered, options);
      for (std::size_t i = 0; i < 6; ++i)
        answered.timing_stddev[i] = std::hypot(answered.timing_stddev[i], lost[i]);
      result.timing_stddev = answered.timing_stddev;
    }
    if (!has(result.findings, finding.code)) result.findings.push_back(std::move(finding));
  }
}

/// Whether the findings, or what replaces them, explain the drive.
bool are_explained(const Foreseen& foreseen, const Answered& answered, const DiagnosisOptions& options,
                   WrongStream& wrong_stream, std::vector<Finding>& findings) {
  const Evidence& evidence = foreseen.evidence;
  const auto is_explanation = [&](const Finding& one) { return explains(one, options); };
  return replace_by_large_move(foreseen.pairing, evidence, answered, options, wrong_stream, findings) ||
         replace_by_moves(foreseen.pairing, evidence, answered, options, findings) ||
         replace_by_wrong_stream(wrong_stream, findings) || one_is_inverted(findings, options) ||
         std::any_of(findings.begin(), findings.end(), is_explanation);
}

/// Faults that are named beside others, in the order in which they depend on each other.
void add_what_is_beside(const Foreseen& foreseen, const DiagnosisOptions& options, WrongStream& wrong_stream,
                        Answered& answered, Diagnosis& result) {
  const Evidence& evidence = foreseen.evidence;
  const PairingOptions& pairing = foreseen.pairing;
  name_wrong_scale(evidence, pairing, answered, options, result.findings);
  replace_by_changing_scale(evidence, pairing, answered, options, result.findings);
  name_same_stream(evidence, answered, options, result);
  add_impossible_pace(evidence, options, result.findings);
  const Vector6d by_lengths = name_lengths_in_turns(evidence, answered, options, result.findings);
  look_at_times(foreseen, answered, result);
  if (!by_lengths.isZero(0)) widen_by(by_lengths, answered, result);
  name_small_scale(evidence, options, answered, result);
  if (pairing.mode != Mode::planar) {
    name_late_rotations(evidence, pairing.max_gap, options, wrong_stream, result.findings);
    widen_by_late_column(wrong_stream.late_column(), answered, result);
    name_early_rotations(evidence, options, answered, result);
    name_late_turning(evidence, options, answered, result);
    // standard deviations that it widens would hide that a part is towed
    name_smoothed_rotations(evidence, pairing.max_gap, options, answered, result);
    name_wandering_headings(evidence, options, answered, result);
  }
  name_askew_rotations(evidence, answered, options, result.findings);
  add_interpolated_streams(foreseen, options, answered, result);
  name_held_streams(evidence, pairing.max_gap, options, result.findings);
  // their single steps contradict each other, too
  if (has(result.findings, "held_a") || has(result.findings, "held_b"))
    std::erase_if(result.findings, [](const Finding& one) { return one.code.starts_with("mixed_frames_"); });
  if (pairing.mode != Mode::planar)
    name_contradicting_runs(evidence.instants, evidence.given.explained.motions, to_pose(answered.T_a_b),
                            options.motions, result.findings);
  // what else was found may be of the stamps alone
  const std::vector<Finding> bursts = stamps_in_bursts(foreseen.a, foreseen.b, result.fit);
  result.findings.insert(result.findings.begin(), bursts.begin(), bursts.end());
}

Diagnosis diagnosed(const Foreseen& foreseen, const Answered& given) {
  const PairingOptions& pairing = foreseen.pairing;
  const Evidence& evidence = foreseen.evidence;
  const Motions& motions = evidence.given.explained.motions;
  const DiagnosisOptions options = in_unit_of(motions, foreseen.options);
  Answered answered = given;
  if (!evidence.instants.empty())
    answered.seconds = evidence.instants.time(evidence.instants.size() - 1) - evidence.instants.time(0);
  answered.platform = forward(heading(motions), options.heading) ? Platform::car : Platform::handheld;
  if (motions.all.size() < options.motions.least) return of_too_few_motions(evidence, answered, options);
  Diagnosis result;
  result.fit = fit_of(evidence, answered, options);
  result.findings = foreseen.findings;
  std::optional<Assumed> level;
  if (pairing.mode != Mode::planar) level = two_dimensions(motions);
  std::optional<Assumed> missing = missing_in_both(evidence.instants, motions);
  for (const std::optional<Assumed>* assumed : {&level, &missing})
    for (std::size_t i = 0; i < 6; ++i)
      if (*assumed && (*assumed)->directions[i]) {
        result.assumed[i] = true;
        answered.observability.observable[i] = false;
      }
  // while the sensors stand, noise would be compared with noise
  Motions moving = without_rest(motions, to_pose(answered.T_a_b));
  // the rotations alone are compared where the translations are noise
  if (travel_in_noise(evidence.instants, motions, to_pose(answered.T_a_b), options.motions))
    moving.translation = 0;
  const RobustFit at_answer = evaluated(moving, answered.T_a_b);
  const DualQuaternion& best = evidence.given.explained.fit.T;
  Misfit misfit{detail::misfit(moving, at_answer), detail::misfit(moving, evaluated(moving, best)),
                median_misfit(moving, at_answer)};
  add_faults_of_poses(evidence, answered, options, result.findings);
  WrongStream wrong_stream(evidence, answered.problem.mode, options);
  replace_by_contents(options, wrong_stream, result.findings);
  const bool explained = are_explained(foreseen, answered, options, wrong_stream, result.findings);
  // noise, or rounding, contradicts every answer
  if (missing || has(result.findings, "too_little_motion")) misfit = {};
  if (!explained)
    look_further(pairing, evidence, answered, result.fit, options, wrong_stream, misfit, result.findings);
  if (pairing.mode != Mode::planar) name_clock_step(evidence, result.fit, options, result.findings);
  add_what_is_beside(foreseen, options, wrong_stream, answered, result);
  drop_unlikely_inversion(evidence, options, result.findings);
  misfit = where_known(misfit, moving, answered, best, result.findings);
  result.findings.insert(result.findings.begin(), foreseen.frozen.begin(), foreseen.frozen.end());
  if (level) result.findings.push_back(std::move(level->finding));
  if (missing) result.findings.insert(result.findings.begin(), std::move(missing->finding));
  judge(result, answered, misfit, options);
  return result;
}

}  // namespace

Diagnosis diagnose(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                   const Answered& answered, const DiagnosisOptions& options) {
  return diagnosed(foresee_streams(a, b, pairing, options), answered);
}

Foresight::Foresight(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                     const DiagnosisOptions& options)
    : foreseen_(std::make_unique<Foreseen>(foresee_streams(a, b, pairing, options))) {
  const std::vector<Finding>& found = foreseen_->findings;
  if (pairing.mode == Mode::planar ||
      std::any_of(found.begin(), found.end(), [](const Finding& one) { return one.certain; }))
    return;
  foreseen_->offset =
      offset_by_turning(middle_part(a, b, options.change.most_poses), pairing, options.clock_check);
  foreseen_->has_offset = true;
}
Foresight::~Foresight() = default;

Diagnosis Foresight::diagnose(const Answered& answered) const {
  return diagnosed(*foreseen_, answered);
}

Diagnosis diagnose(std::span<const MotionPair> pairs, const Answered& answered,
                   const DiagnosisOptions& given) {
  const Motions motions = motions_of(pairs, given.motions);
  const DiagnosisOptions options = in_unit_of(motions, given);
  Diagnosis result;
  result.fit = fit_at(motions, to_pose(answered.T_a_b), 0, options.motions);
  Misfit misfit;
  if (motions.all.size() >= options.motions.least) {
    misfit.at_answer = misfit.best = detail::misfit(motions, evaluated(motions, answered.T_a_b));
    if (answered.problem.mode == Mode::planar)
      result.findings =
          check_planes({motions, robust_fit(motions, options.fit)}, answered.problem.plane_a,
                       answered.problem.plane_b, options.unit == LengthUnit::metres, options.planes);
  } else {
    result.findings.push_back(too_little_motion(motions.all.size(), options));
  }
  judge(result, answered, misfit, options);
  return result;
}

Diagnosis diagnose(const Answered& answered, const DiagnosisOptions& options) {
  Diagnosis result;
  judge(result, answered, {}, options);
  return result;
}

}  // namespace egocal
