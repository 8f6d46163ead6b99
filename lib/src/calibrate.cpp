// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/calibrate.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "calibration/inverted_streams.hpp"
#include "calibration/no_motions.hpp"
#include "calibration/rounded_streams.hpp"
#include "calibration/scale_verdict.hpp"
#include "calibration/steps.hpp"
#include "diagnosis/explanations/times/clock_check.hpp"
#include "diagnosis/verdict/judge.hpp"
#include "egocal/calibrate_beside.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/diagnosis/foresee.hpp"
#include "egocal/error.hpp"
#include "egocal/estimation/attenuation.hpp"
#include "egocal/pairing/congruence.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/pairing/outlier_choice.hpp"
#include "egocal/pairing/selection.hpp"
#include "egocal/robust/prove_outliers.hpp"
#include "egocal/robust/robust_statistics.hpp"
#include "egocal/scale/estimate_scale.hpp"
#include "pairing/likeliest_balance.hpp"

namespace egocal {

using detail::answered;
using detail::as_read;
using detail::diagnose_without_poses;
using detail::judged;
using detail::no_motions_in_words;
using detail::put_scale;
using detail::scale_options;
using detail::solved;
using detail::with_rounding;

namespace {

/// The problem with mode, planes, balance and prior, and no motions yet.
Problem formulation(const PairingOptions& options) {
  Problem problem;
  problem.mode = options.mode;
  problem.plane_a = options.plane_a;
  problem.plane_b = options.plane_b;
  problem.balance = options.balance.value_or(Balance{});
  problem.prior = options.prior;
  return problem;
}

/// The balance with the smallest jack-knife spread, or with the most likely answer if none has a spread.
/// Motions of a file have no strides to choose from.
Choice choose_balance(const Problem& problem, const PairingOptions& options) {
  Choice choice;
  choice.balance = problem.balance;
  choice.reason = "fixed";
  if (options.balance) return choice;
  choice.reason = "too few motions to choose";
  const MotionsOfStride motions{1, problem.blocks};
  const std::optional<SelectedSetting> selected =
      select_setting(problem, {&motions, 1}, options.accumulator.balances, std::nullopt, std::nullopt);
  if (!selected) {
    const auto& balances = options.accumulator.balances;
    if (const auto likeliest = detail::likeliest_balance(problem, motions, balances)) {
      choice.balance = *likeliest;
      choice.reason = "most likely of " + std::to_string(balances.size()) + " balances";
    }
    return choice;
  }
  choice.balance = selected->setting.balance;
  choice.reason = "smallest jack-knife spread of " + std::to_string(selected->tried) + " balances";
  return choice;
}

/// The problem with rotation noise taken off; empty where that is not needed.
std::optional<Problem> without_rotation_noise(const Problem& problem, Choice& choice) {
  const std::optional<Attenuation> attenuation = find_attenuation(problem);
  if (!attenuation) return std::nullopt;
  std::optional<Problem> corrected = without_attenuation(problem, *attenuation);
  if (corrected) choice.reason += ", rotation noise taken off";
  return corrected;
}

bool with_scale(const CalibrationOptions& options) {
  return options.estimate_scale || options.scale != 1;
}

CalibrationOptions without_scale(CalibrationOptions options, const std::optional<ScaleSolution>& estimate) {
  if (estimate) options.diagnosis.unit = unit_of_scaled(options.diagnosis.unit, estimate->scale);
  options.estimate_scale = false;
  options.scale = 1;
  return options;
}

/// The same tolerance as the diagnosis has, by motions as long as those that it begins with.
DiagnosisOptions in_unit_of_streams(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                                    const DiagnosisOptions& options) {
  const detail::Instants instants =
      detail::synchronised(a, b, {pairing.time_offset, 0, 0}, pairing.max_gap, 1, options.motions);
  const int stride = std::max(1, static_cast<int>(instants.size()) / 32);
  return detail::in_unit_of(
      detail::motions_of(instants, {}, {}, stride, options.motions.most, options.motions), options);
}

/// What it means that another time offset fits as well.
void put_rival_offset(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                      const DiagnosisOptions& options, Calibration& result) {
  TimeOffset rival = *result.time_offset;
  rival.seconds = *rival.rival;
  const Trajectory on_clock = on_clock_of_a(rival, b);
  const Problem problem = paired(pairing, a, on_clock).problem();
  if (problem.blocks.empty()) return;
  const Finding finding =
      detail::rival_clock_offset(*result.time_offset, solve(problem, Method::dual).minimum);
  result.findings.push_back(finding);
  const std::string reason = detail::rival_in_words(finding, result.minimum, result.observability,
                                                    in_unit_of_streams(a, on_clock, pairing, options));
  if (reason.empty() || result.verdict != Verdict::good) return;
  result.verdict = Verdict::incomplete;
  result.reason = reason;
}

/// Calibrates streams with lengths in one unit. scale: found before, and its uncertainty adds to that of the
/// answer. beside: may be empty.
Calibration calibrate_streams(const Trajectory& a, const Trajectory& given_b,
                              const CalibrationOptions& options, const Beside& beside,
                              const std::optional<ScaleSolution>& scale) {
  PairingOptions pairing_options = options.pairing;
  std::optional<TimeOffset> time_offset;
  if (options.estimate_time_offset) {
    time_offset = estimate_time_offset(a, given_b, {.max_gap = validated(pairing_options).max_gap});
    if (!time_offset)
      throw Error("time offset: cannot be estimated, the streams are too short or never turn");
    // an offset cannot express a drift, so the stamps themselves are corrected
    pairing_options.time_offset = 0;
  }
  std::optional<Trajectory> corrected;
  if (time_offset) corrected = on_clock_of_a(*time_offset, given_b);
  const Trajectory& b = corrected ? *corrected : given_b;
  pairing_options = with_rounding(std::move(pairing_options), a, b);
  std::optional<MotionPairing> pairing_of_all;
  std::optional<Foresight> foresight;
  const auto pair = [&] { pairing_of_all.emplace(paired(pairing_options, a, b, beside)); };
  const auto foresee = [&] {
    try {
      foresight.emplace(a, b, pairing_options, options.diagnosis);
    } catch (const Error&) {
      // streams without motions are not diagnosed; of others diagnose() throws it again
    }
  };
  if (beside && options.diagnosis.enabled)
    beside(pair, foresee);
  else
    pair();
  const MotionPairing& pairing = *pairing_of_all;
  Problem problem = pairing.problem();
  if (problem.blocks.empty())
    throw AdvisedError(no_motions_in_words(a, b, pairing.counts(), pairing_options.max_gap));
  Calibration result = solved(std::move(problem), pairing.choice(), pairing.counts(), options.method);
  if (options.diagnosis.enabled) result.outliers = prove_outliers(pairing);
  result.time_offset = time_offset;
  result.time_offset_applied = time_offset ? time_offset->seconds : pairing_options.time_offset;
  const Answered what = answered(result, pairing.single_stride_problem(), scale);
  Diagnosis diagnosis = foresight                   ? foresight->diagnose(what)
                        : options.diagnosis.enabled ? diagnose(a, b, pairing_options, what, options.diagnosis)
                                                    : diagnose_without_poses(what, options.diagnosis);
  result = judged(std::move(result), std::move(diagnosis));
  if (time_offset && time_offset->rival && options.diagnosis.enabled)
    put_rival_offset(a, given_b, pairing_options, options.diagnosis, result);
  return result;
}

Calibration calibrate_pairs(std::span<const MotionPair> given, const CalibrationOptions& options,
                            const std::optional<ScaleSolution>& scale) {
  const PairingOptions& pairing = options.pairing;
  PairingCounts counts;
  std::vector<MotionPair> pairs(given.begin(), given.end());
  if (pairing.robust) {
    const std::vector<bool> wrong = incongruent(pairs, pairing.screening);
    std::size_t i = 0;
    counts.rejected[static_cast<std::size_t>(Rejection::screw_congruence)] =
        std::erase_if(pairs, [&](const MotionPair&) { return wrong[i++]; });
  }
  Problem problem = formulation(pairing);
  if (pairing.mode == Mode::planar) {
    const DualQuaternion G_a = plane_frame(pairing.plane_a), G_b = plane_frame(pairing.plane_b);
    for (MotionPair& pair : pairs) {
      pair.a = planar_motion(pair.a, G_a);
      pair.b = planar_motion(pair.b, G_b);
    }
  }
  RobustStatistics statistics;
  for (const MotionPair& pair : pairs) {
    if (!pairing.robust) {
      statistics.add_unjudged(pair);
      continue;
    }
    statistics.add(pair, problem);
    if (statistics.look_is_due()) statistics.look(problem);
  }
  if (pairing.robust) statistics.look(problem);
  problem.blocks = statistics.inliers();
  counts.matched = statistics.inlier_pairs();
  counts.outliers = statistics.outlier_pairs();
  Choice choice = choose_balance(problem, pairing);
  problem.balance = choice.balance;
  std::optional<Problem> corrected;
  if (!pairing.balance) corrected = without_rotation_noise(problem, choice);
  Calibration result = solved(corrected.value_or(problem), std::move(choice), counts, options.method);
  if (pairing.robust) result.outliers = prove_outliers(problem, statistics);
  return judged(result, diagnose(given, answered(result, problem, scale), options.diagnosis));
}

/// Scales one stream, then calibrates as without a scale.
Calibration calibrate_scaled(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options,
                             const Beside& beside) {
  std::optional<ScaleSolution> estimate;
  PairingOptions pairing = options.pairing;
  if (options.estimate_scale) {
    // rotations alone show the time offset; lengths of one unit refine it once the scale is known
    std::optional<TimeOffset> offset;
    if (options.estimate_time_offset)
      offset = estimate_time_offset(a, b, {.max_gap = validated(pairing).max_gap});
    if (offset) pairing.time_offset = 0;
    std::optional<Trajectory> corrected;
    if (offset) corrected = on_clock_of_a(*offset, b);
    const Trajectory& on_clock = corrected ? *corrected : b;
    estimate = estimate_scale(a, on_clock, pairing, scale_options(options));
    if (!estimate)
      throw AdvisedError(
          no_motions_in_words(a, on_clock, paired(pairing, a, on_clock).counts(), pairing.max_gap));
  }
  const double scale = estimate ? estimate->scale : options.scale;
  const bool on_a = options.scale_side == Side::a;
  Calibration result = calibrate_streams(on_a ? scaled(a, scale) : a, on_a ? b : scaled(b, scale),
                                         without_scale(options, estimate), beside, estimate);
  put_scale(estimate, scale, options, result);
  return result;
}

Calibration calibrate_scaled(std::span<const MotionPair> pairs, const CalibrationOptions& options) {
  if (options.pairing.mode == Mode::planar && options.estimate_scale)
    throw Error("scale: cannot be estimated from motion pairs in planar mode; give it, or trajectories");
  std::optional<ScaleSolution> estimate;
  if (options.estimate_scale) estimate = estimate_scale(pairs, scale_options(options));
  const double scale = estimate ? estimate->scale : options.scale;
  std::vector<MotionPair> scaled_pairs(pairs.begin(), pairs.end());
  for (MotionPair& pair : scaled_pairs) {
    DualQuaternion& motion = options.scale_side == Side::a ? pair.a : pair.b;
    motion = scaled(motion, scale);
  }
  Calibration result = calibrate_pairs(scaled_pairs, without_scale(options, estimate), estimate);
  put_scale(estimate, scale, options, result);
  return result;
}

}  // namespace

std::string rejections_in_words(const PairingCounts& counts) {
  std::string text;
  for (std::size_t i = 0; i < counts.rejected.size(); ++i)
    if (counts.rejected[i] > 0)
      text += (text.empty() ? "rejected: " : ", ") + std::to_string(counts.rejected[i]) + " " +
              std::string(to_string(static_cast<Rejection>(i)));
  return text.empty() ? "none rejected" : text;
}

std::string motions_in_words(const Calibration& calibration) {
  const Choice& choice = calibration.choice;
  const auto count = static_cast<unsigned long long>(sum_blocks(calibration.problem.blocks).count);
  char text[160];
  if (choice.mean_stride > 0)
    std::snprintf(text, sizeof text, "of many strides between %llu instants", count);
  else
    std::snprintf(text, sizeof text, "%llu pairs, stride %d, weights rotation : translation = %g : %g", count,
                  choice.stride, choice.balance.rotation, choice.balance.translation);
  return text + (" (" + choice.reason + ")");
}

Calibration calibrate(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options) {
  return calibrate(a, b, options, Beside{});
}

Calibration calibrate(const Trajectory& a, const Trajectory& b, const CalibrationOptions& options,
                      const Beside& beside) {
  if (!as_read(options.read_a) || !as_read(options.read_b)) {
    CalibrationOptions rest = options;
    rest.read_a = rest.read_b = {};
    if (options.read_a.scale == 1 && options.read_b.scale == 1)
      rest.pairing = with_rounding(std::move(rest.pairing), a, b);  // an inverse pose has more digits
    const Trajectory read_a = reread(a, options.read_a), read_b = reread(b, options.read_b);
    Calibration result = calibrate(read_a, read_b, rest, beside);
    // a scale that is looked for is another question, and its lengths are not those of these streams
    if (options.read_a.invert && options.read_b.invert && !with_scale(options))
      detail::doubt_inversion_of_both(read_a, read_b, rest, result);
    return result;
  }
  if (with_scale(options)) return calibrate_scaled(a, b, options, beside);
  return calibrate_streams(a, b, options, beside, std::nullopt);
}

Calibration calibrate(std::span<const MotionPair> given, const CalibrationOptions& options) {
  if (given.empty()) throw Error("no motion pairs");
  if (with_scale(options)) return calibrate_scaled(given, options);
  return calibrate_pairs(given, options, std::nullopt);
}

}  // namespace egocal
