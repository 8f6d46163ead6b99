// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "diagnosis/clock_check.hpp"
#include "egocal/calibrate_beside.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/diagnosis/foresee.hpp"
#include "egocal/error.hpp"
#include "egocal/estimation/attenuation.hpp"
#include "egocal/in_words.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/pairing/congruence.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/pairing/outlier_choice.hpp"
#include "egocal/pairing/selection.hpp"
#include "egocal/robust/prove_outliers.hpp"
#include "egocal/robust/robust_statistics.hpp"
#include "egocal/scale/estimate_scale.hpp"
#include "pairing/offset/turning.hpp"

namespace egocal {

namespace {

Calibration solved(Problem problem, Choice choice, const PairingCounts& counts, Method method) {
  Calibration result;
  result.choice = std::move(choice);
  result.counts = counts;
  const Answer answer = solve(problem, method);
  result.T_a_b = to_pose(answer.T_a_b);
  result.minimum = to_pose(answer.minimum);
  result.T_b_a = inverse(result.T_a_b);
  result.certificate = answer.certificate;
  result.observability = answer.observability;
  result.status = answer.status;
  result.problem = std::move(problem);
  return result;
}

/// single: motions of one stride, which the diagnosis takes apart.
Answered answered(const Calibration& calibration, Problem single,
                  const std::optional<ScaleSolution>& scale = std::nullopt) {
  Answered result;
  result.T_a_b = to_dual_quaternion(calibration.minimum);
  result.observability = calibration.observability;
  result.counts = calibration.counts;
  result.problem = std::move(single);
  result.stride = calibration.choice.stride;
  result.minimised = calibration.problem;
  if (scale) result.scale_stddev = with_spread_of_scale({}, calibration.problem, *scale);
  return result;
}

Calibration judged(Calibration calibration, Diagnosis diagnosis) {
  calibration.verdict = diagnosis.verdict;
  for (std::size_t i = 0; i < diagnosis.timing_stddev.size(); ++i)
    if (diagnosis.timing_stddev[i] > 0)  // else not a bit is changed
      calibration.observability.stddev[i] =
          std::hypot(calibration.observability.stddev[i], diagnosis.timing_stddev[i]);
  calibration.reason = std::move(diagnosis.reason);
  calibration.fit = std::move(diagnosis.fit);
  calibration.findings = std::move(diagnosis.findings);
  calibration.goal = std::move(diagnosis.goal);
  return calibration;
}

/// What was answered says how well each direction is known, but not whether the motions agree.
Diagnosis diagnose_without_poses(const Answered& answered, const DiagnosisOptions& options) {
  Diagnosis diagnosis = diagnose(answered, options);
  if (diagnosis.verdict != Verdict::good) return diagnosis;
  diagnosis.verdict = Verdict::incomplete;
  diagnosis.reason = "All directions are known; whether the motions agree was not looked at.";
  return diagnosis;
}

bool as_read(const Reading& reading) {
  return reading.quaternion_order == QuaternionOrder::as_read && !reading.invert && reading.scale == 1;
}

/// Streams of one drive hardly differ more in length; other units of time differ by a thousand.
constexpr double other_unit = 100;  // limit of a hint

/// Other units, or other clocks, such as the time since the start of a log beside that since 1970.
std::string times_in_words(const Trajectory& a, const Trajectory& b) {
  if (a.empty() || b.empty()) return "";
  const auto lasts = [](const Trajectory& x) {
    return static_cast<double>(x.back().time_us) - static_cast<double>(x.front().time_us);
  };
  const double ratio = lasts(b) / lasts(a);
  if (lasts(a) > 0 && lasts(b) > 0 && !(ratio < other_unit && ratio > 1 / other_unit)) {
    char text[128];
    std::snprintf(text, sizeof text,
                  "; %s lasts %.3g times as long: multiply its times if they are in another unit",
                  ratio > 1 ? "b" : "a", std::max(ratio, 1 / ratio));
    return text;
  }
  if (a.front().time_us <= b.back().time_us && b.front().time_us <= a.back().time_us) return "";
  return "; their times do not overlap: --time-offset auto if they are of one drive";
}

/// Streams that are too slow for the longest gap that is interpolated over, where that left no motions.
std::string gaps_in_words(const Trajectory& a, const Trajectory& b, const PairingCounts& counts,
                          double max_gap) {
  if (counts.rejected[static_cast<std::size_t>(Rejection::gap)] == 0 || a.size() < 2 || b.size() < 2)
    return "";
  const double step_a = to_seconds(detail::median_period_us(a)),
               step_b = to_seconds(detail::median_period_us(b));
  if (!(std::min(step_a, step_b) > max_gap)) return "";
  char text[192];
  std::snprintf(text, sizeof text,
                "; the median time between poses is %.3g s in a and %.3g s in b, but nothing is interpolated "
                "over more than %.3g s: --max-gap SECONDS allows more",
                step_a, step_b, max_gap);
  return text;
}

/// A pose that is computed once a second and sent ten times, where that left no motions: the repeats are
/// rejected, and the new ones have no neighbour.
std::string repeats_in_words(const Trajectory& a, const Trajectory& b, const PairingCounts& counts) {
  if (counts.rejected[static_cast<std::size_t>(Rejection::frozen)] == 0) return "";
  const auto repeats = [](const StampedPose& x, const StampedPose& y) {
    return x.pose.real == y.pose.real && x.pose.dual == y.pose.dual;
  };
  std::string text;
  for (const auto& [name, stream] : {std::pair("a", &a), std::pair("b", &b)}) {
    std::size_t differ = 1, newest = 0;
    for (std::size_t i = 1; i < stream->size(); ++i) {
      if (repeats((*stream)[i - 1], (*stream)[i])) continue;
      ++differ;
      newest = i;
    }
    if (2 * differ > stream->size()) continue;  // as many are whole motions, and reject none of the others
    const double lasts = seconds_between(stream->front().time_us, (*stream)[newest].time_us);
    char line[256];
    if (differ == 1)
      std::snprintf(line, sizeof line,
                    "; the poses of %s are all the same while the other sensor moves: it does not work, or "
                    "other columns are its poses",
                    name);
    else
      std::snprintf(
          line, sizeof line,
          "; %s repeats its poses: of its %zu only %zu differ from the one before, one every %.3g s. "
          "Keep the first of each and leave out its repeats, or record the odometry before it is "
          "sent again at a fixed rate",
          name, stream->size(), differ, lasts / static_cast<double>(differ - 1));
    text += line;
  }
  return text;
}

/// Mode, planes, balance and prior; no motions yet.
Problem formulation(const PairingOptions& options) {
  Problem problem;
  problem.mode = options.mode;
  problem.plane_a = options.plane_a;
  problem.plane_b = options.plane_b;
  problem.balance = options.balance.value_or(Balance{});
  problem.prior = options.prior;
  return problem;
}

/// The balance with the smallest jack-knife spread; the motions of a file have no strides to choose from.
Choice choose_balance(const Problem& problem, const PairingOptions& options) {
  Choice choice;
  choice.balance = problem.balance;
  choice.reason = "fixed";
  if (options.balance) return choice;
  choice.reason = "too few motions to choose";
  const MotionsOfStride motions{1, problem.blocks};
  const std::optional<SelectedSetting> selected =
      select_setting(problem, {&motions, 1}, options.accumulator.balances, std::nullopt, std::nullopt);
  if (!selected) return choice;
  choice.balance = selected->setting.balance;
  choice.reason = "smallest jack-knife spread of " + std::to_string(selected->tried) + " balances";
  return choice;
}

/// Empty where that is not needed.
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

CalibrationOptions without_scale(CalibrationOptions options) {
  options.estimate_scale = false;
  options.scale = 1;
  return options;
}

DriveScaleOptions scale_options(const CalibrationOptions& options) {
  DriveScaleOptions result;
  result.scale.side = options.scale_side;
  return result;
}

/// What the scale adds to an answer.
void put_scale(const std::optional<ScaleSolution>& estimate, double scale, Calibration& result) {
  result.scale = estimate;
  result.scale_applied = scale;
  if (estimate)
    result.observability.stddev =
        with_spread_of_scale(result.observability.stddev, result.problem, *estimate);
  if (!estimate || (estimate->observable && estimate->certified) || result.verdict != Verdict::good) return;
  result.verdict = Verdict::incomplete;
  result.reason = estimate->observable ? "The scale is not proven to be the best one."
                                       : "The motions do not show the scale.";
}

/// What it means that another time offset fits as well.
void put_rival_offset(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                      const DiagnosisOptions& options, Calibration& result) {
  TimeOffset rival = *result.time_offset;
  rival.seconds = *rival.rival;
  const Problem problem = paired(pairing, a, on_clock_of_a(rival, b)).problem();
  if (problem.blocks.empty()) return;
  const Finding finding =
      detail::rival_clock_offset(*result.time_offset, solve(problem, Method::dual).minimum);
  result.findings.push_back(finding);
  const std::string reason = detail::rival_in_words(finding, result.minimum, result.observability, options);
  if (reason.empty() || result.verdict != Verdict::good) return;
  result.verdict = Verdict::incomplete;
  result.reason = reason;
}

/// Of streams whose lengths are in one unit. scale: found before, which adds to what is not known. beside:
/// may be empty.
Calibration calibrate_streams(const Trajectory& a, const Trajectory& given_b,
                              const CalibrationOptions& options, const Beside& beside,
                              const std::optional<ScaleSolution>& scale) {
  PairingOptions pairing_options = options.pairing;
  std::optional<TimeOffset> time_offset;
  if (options.estimate_time_offset) {
    time_offset = estimate_time_offset(a, given_b, {.max_gap = validated(pairing_options).max_gap});
    if (!time_offset)
      throw Error("time offset: cannot be estimated, the streams are too short or never turn");
    pairing_options.time_offset =
        0;  // a drift cannot be expressed by it: the stamps themselves are corrected
  }
  std::optional<Trajectory> corrected;
  if (time_offset) corrected = on_clock_of_a(*time_offset, given_b);
  const Trajectory& b = corrected ? *corrected : given_b;
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
    throw Error("no motion pairs; a: " + span_in_words(a) + ", b: " + span_in_words(b) + "; " +
                rejections_in_words(pairing.counts()) + times_in_words(a, b) +
                gaps_in_words(a, b, pairing.counts(), pairing_options.max_gap) +
                repeats_in_words(a, b, pairing.counts()));
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
    // rotations alone show the time offset, whatever the scale
    std::optional<TimeOffset> offset;
    if (options.estimate_time_offset)
      offset = estimate_time_offset(a, b, {.max_gap = validated(pairing).max_gap});
    if (offset) pairing.time_offset = 0;
    estimate = estimate_scale(a, offset ? on_clock_of_a(*offset, b) : b, pairing, scale_options(options));
  }
  const double scale = estimate ? estimate->scale : options.scale;
  const bool on_a = options.scale_side == Side::a;
  Calibration result = calibrate_streams(on_a ? scaled(a, scale) : a, on_a ? b : scaled(b, scale),
                                         without_scale(options), beside, estimate);
  put_scale(estimate, scale, result);
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
  Calibration result = calibrate_pairs(scaled_pairs, without_scale(options), estimate);
  put_scale(estimate, scale, result);
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
    return calibrate(reread(a, options.read_a), reread(b, options.read_b), rest, beside);
  }
  if (with_scale(options)) return calibrate_scaled(a, b, options, beside);
  return calibrate_streams(a, b, options, beside, std::nullopt);
}

Calibration calibrate(std::span<const MotionPair> given, const CalibrationOptions& options) {
  if (given.empty()) throw Error("no motion pairs");
  if (with_scale(options)) return calibrate_scaled(given, options);
  return calibrate_pairs(given, options, std::nullopt);
}

struct Calibrator::Impl {
  CalibrationOptions options;
  MotionPairing pairing;
};

namespace {

PairingOptions pairing_options(const CalibrationOptions& options) {
  PairingOptions pairing = options.pairing;
  if (options.estimate_time_offset) pairing.track_time_offset = true;
  return pairing;
}

}  // namespace

Calibrator::Calibrator(CalibrationOptions options) {
  if (options.estimate_scale)
    throw Error("estimate_scale: the whole drive shows it; give `scale`, or use calibrate()");
  MotionPairing pairing(pairing_options(options));
  impl_.reset(new Impl{std::move(options), std::move(pairing)});
}
Calibrator::~Calibrator() = default;
Calibrator::Calibrator(Calibrator&&) noexcept = default;
Calibrator& Calibrator::operator=(Calibrator&&) noexcept = default;

void Calibrator::add(Side side, const StampedPose& pose) {
  const CalibrationOptions& options = impl_->options;
  const Reading& reading = side == Side::a ? options.read_a : options.read_b;
  StampedPose understood = pose;
  if (!as_read(reading)) understood = reread({understood}, reading).front();
  if (options.scale_side == side && options.scale != 1)
    understood.pose = scaled(understood.pose, options.scale);
  impl_->pairing.push(side, understood);
}

void Calibrator::finish() {
  impl_->pairing.finish();
}

PairingCounts Calibrator::counts() const {
  return impl_->pairing.counts();
}

std::optional<Calibration> Calibrator::answer() const {
  const MotionPairing& pairing = impl_->pairing;
  Problem problem = pairing.problem();
  if (problem.blocks.empty()) return std::nullopt;
  Calibration result = solved(std::move(problem), pairing.choice(), pairing.counts(), impl_->options.method);
  result.time_offset_applied = pairing.time_offset().value_or(0);
  result.scale_applied = impl_->options.scale;
  return judged(result, diagnose_without_poses(answered(result, pairing.single_stride_problem()),
                                               impl_->options.diagnosis));
}

}  // namespace egocal
