// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/explanations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/explanations/best_reading.hpp"
#include "diagnosis/explanations/both_streams.hpp"
#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/lengths/scale.hpp"
#include "diagnosis/motions/axes.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/mount/large_move.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/scale/estimate_scale.hpp"

namespace egocal::detail {

namespace {

/// Typical speed of a, as given [m/s]; 0 where it is not known. Half of the way is travelled faster: it may
/// stand most of the time.
double speed_of_a(const Evidence& evidence) {
  const double duration = evidence.stride * evidence.instants.period;
  std::vector<std::pair<double, double>> lengths;
  for (const Motion& motion : evidence.given.explained.motions.all)
    lengths.emplace_back(motion.t_a.norm(), motion.t_a.norm());
  return duration > 0 && !lengths.empty() ? weighted_median(std::move(lengths)) / duration : 0;
}

Finding scale_finding(const Explanation& explanation, const Comparison& comparison, bool certain,
                      const Evidence& evidence, const DiagnosisOptions& options) {
  const double power = std::round(std::log10(explanation.scale) / 3);
  const bool units = power != 0 && std::abs(std::log(explanation.scale / std::pow(1000, power))) <
                                       options.scale.unit_tolerance;
  Finding finding = finding_of(explanation, comparison, certain);
  finding.code = units ? "units" : "scale";
  finding.value = units ? std::pow(1000, power) : explanation.scale;
  if (!units) return worded_scale(std::move(finding));
  // in the unit of the shorter one, the longer stream goes as the shorter one does
  const double speed = speed_of_a(evidence), of_longer = power > 0 ? speed / explanation.scale : speed;
  const bool shorter_likelier = of_longer > 0 && of_longer < options.scale.slowest;
  finding = worded_scale(std::move(finding), shorter_likelier);
  // the answer is in the units of a: those of the longer stream are the wrong ones, or of the shorter one
  if ((power > 0) != shorter_likelier) finding.T_a_b->translation /= *finding.value;
  return finding;
}

/// sigmas: by how many of its standard deviations the scale differs from one.
Finding shown_by_few(const Evidence& evidence, const Comparison& comparison, double sigmas,
                     const DiagnosisOptions& options) {
  const Explanation& scaled = evidence.scaled;
  Finding finding = scale_finding(scaled, comparison, true, evidence, options);
  if (finding.code == "scale" && comparison.gain < options.gain)
    say(finding, format("The lengths of {b} times %.4g fit those of {a}", scaled.scale), finding.words.cure,
        format(": few motions show it, but by %.0f standard deviations.", sigmas));
  return finding;
}

/// Shorter motions hold fewer wrong poses, but more noise: they are compared where they leave less.
struct StrideOptions {
  double less = 0.8;  ///< of the typical squares, at most
  /// Single steps, after motions of fewer than this many, only where nearly nothing is left: they do on runs
  /// of the public benchmark with 10 % of wrong steps, whose motions over three steps are wrong by half. At
  /// 0.8 the noise of one of its clean runs with drift, too, was compared by steps.
  int noisy = 4;
  double less_where_noisy = 0.1;
};

/// What two clocks differ by at most, in a drive from `begin` to `end` [s].
double largest_difference(const ClockModel& one, const ClockModel& other, double begin, double end) {
  double largest = 0;
  for (const double time : {begin, end})
    largest = std::max(largest, std::abs(one.on_clock_of_a(time) - other.on_clock_of_a(time)));
  return largest;
}

/// Clock offset, and drift if that explains more, on top of an explanation.
std::vector<Explanation> with_clock(const Evidence& evidence, const Explanation& best,
                                    const DiagnosisOptions& options) {
  Streams streams = evidence.streams;
  streams.read_a = best.read_a;
  streams.read_b = best.read_b;
  streams.read_b.scale *= best.scale;
  streams.motion_length = evidence.stride * evidence.instants.period;
  // a long drive has more instants than a clock needs: a few in each motion
  streams.each =
      std::clamp<std::size_t>(evidence.instants.size() / options.clock.instants, 1,
                              std::max<std::size_t>(1, static_cast<std::size_t>(evidence.stride) / 8));
  std::vector<Explanation> result;
  const double length = to_seconds(streams.a.back().time_us - streams.a.front().time_us);
  const auto take = [&](const char* code, const std::optional<ClockFit>& fit, const Explained& against) {
    if (!fit || largest_difference(fit->clock, evidence.clock, 0, length) < options.clock.least ||
        !number_explains(compare(against, fit->explained), options))
      return;
    Explanation here = best;
    here.code = code;
    here.clock = fit->clock;
    here.explained = fit->explained;
    result.push_back(std::move(here));
  };
  const ClockFits fits = fit_clock(streams, evidence.clock);
  take("clock_offset", fits.offset, best.explained);
  const Explained& so_far = result.empty() ? best.explained : result.back().explained;
  take("clock_drift", fits.drift, Explained(so_far));
  return result;
}

/// Which of two streams is inverted shows in metres, but not on a clock that is off: the other one is taken
/// where it fits better with the clock that suits it. clocks: those of the best one.
void take_better_twin(const Evidence& evidence, const DiagnosisOptions& options, Explanation& best,
                      Explanation& twin, std::vector<Explanation>& clocks) {
  if (!best.code.starts_with("inverted_") || !twin.code.starts_with("inverted_")) return;
  std::vector<Explanation> of_twin = with_clock(evidence, twin, options);
  if (of_twin.empty() || !(loss_in_metres(of_twin.back().explained, clocks.back().explained) > 0)) return;
  std::swap(best, twin);
  clocks = std::move(of_twin);
}

/// Positions that are turned by less than what makes an answer wrong: an honest odometry that drifts by a per
/// cent of its way does that, too. What else changes of the answer decides.
bool turns_within_tolerance(const Explanation& explanation, const DiagnosisOptions& options) {
  const auto turns_little = [&](const PoseReading& reading) {
    return !reading.invert && !reading.conjugate && reading.axes.determinant() > 0 &&
           turn_of(reading.axes).norm() < options.tolerance_rotation;
  };
  return explanation.code.starts_with("axes_") && turns_little(explanation.read_a) &&
         turns_little(explanation.read_b);
}

/// The part of the drive that an explanation leaves out: a file whose convention changes on its way.
std::optional<UnexplainedPart> left_out_by(const Explained& final) {
  LargeMoveOptions shortest;
  shortest.least_part = 1.0 / 6;  // two windows: every sixth of the drive was asked for by nothing else
  return unexplained_part(final.motions, final.fit.T, shortest);
}

/// The motions outside of a part of the drive, with the extrinsic that suits them best. Blocks have as many
/// motions as before.
Explained without_part(const Explained& whole, const UnexplainedPart& part, const DiagnosisOptions& options) {
  Explained rest{whole.motions, {}};
  std::vector<Motion>& motions = rest.motions.all;
  std::erase_if(motions,
                [&](const Motion& motion) { return motion.time >= part.begin && motion.time < part.end; });
  if (motions.empty()) return rest;
  rest.motions.blocks =
      std::max<std::size_t>(1, whole.motions.blocks * motions.size() / whole.motions.all.size());
  rest.fit = robust_fit(rest.motions, options.fit);
  return rest;
}

/// Whether what holds without a part fits the rest better than the streams as given do. Otherwise it only
/// suits something in that part, which is wrong by itself.
bool explains_the_rest(const Explained& given, const Explained& final, const UnexplainedPart& part,
                       const DiagnosisOptions& options) {
  return better(compare(without_part(given, part, options), without_part(final, part, options)),
                options.least_gain, options);
}

/// What holds in a part of the drive only cures nothing by itself.
void name_part(const UnexplainedPart& part, std::vector<Finding>& findings) {
  for (Finding& finding : findings) {
    FindingWords words = finding.words;
    words.evidence += format(" This explains the drive without the part from %.0f to %.0f s after the start.",
                             part.begin, part.end);
    words.scope =
        format("Calibrate the drive from %.0f to %.0f s separately; of the rest: ", part.begin, part.end);
    say(finding, std::move(words));
  }
}

}  // namespace

Evidence gather(const Trajectory& a, const Trajectory& b, const ClockModel& clock, double max_gap,
                const DiagnosisOptions& options) {
  Evidence evidence{turning_of(a),
                    turning_of(b),
                    {a, b, {}, {}, max_gap, 1, options, {}, {}},
                    clock,
                    synchronised(a, b, clock, max_gap, 1, options.motions).remembering(),
                    1,
                    {},
                    {}};
  evidence.streams.turning_a = evidence.turning_a;
  evidence.streams.turning_b = evidence.turning_b;
  evidence.given.clock = clock;
  const auto n = static_cast<int>(evidence.instants.size());
  double least = INFINITY;
  std::vector<Candidate> readings = common_mistakes();
  readings.insert(readings.begin(), Candidate{"", {}, {}});
  const StrideOptions steps;
  int longer = n;
  for (int stride = std::max(1, n / 32), looks = 0; looks < 4; ++looks) {
    const double less = longer < steps.noisy ? steps.less_where_noisy : steps.less;
    for (const Candidate& candidate : readings) {
      const Motions motions = motions_of(evidence.instants, candidate.a, candidate.b, stride,
                                         options.motions.first_look, options.motions);
      if (motions.all.empty()) continue;
      const double typical = quick_fit(motions, options.fit).typical;
      if (typical < less * least) {
        least = typical;
        evidence.stride = stride;
      }
    }
    if (stride == 1) break;
    longer = stride;
    stride = std::max(1, stride / 4);
  }
  evidence.given.explained = explained(evidence, "", {}, {}, options).explained;
  evidence.scaled = with_scale(evidence.given, options);
  return evidence;
}

std::vector<Finding> explain(const Evidence& evidence, const DiagnosisOptions& options) {
  std::vector<Finding> findings;
  if (evidence.given.explained.motions.all.size() < 4) return findings;
  const Explained& given = evidence.given.explained;

  BestReading reading = best_reading(evidence, options);
  Explanation best = reading.best;
  // a clock that is off can look like anything: it is tried on the streams as given, too
  std::vector<Explanation> clocks = with_clock(evidence, evidence.given, options);
  if (!clocks.empty() && !better(compare(clocks.back().explained, best.explained), options.gain, options)) {
    best = evidence.given;
    reading.twin.reset();
  } else if (!best.code.empty() || best.scale != 1)
    clocks = with_clock(evidence, best, options);
  if (reading.twin && !clocks.empty()) take_better_twin(evidence, options, best, *reading.twin, clocks);

  const Explained& final = clocks.empty() ? best.explained : clocks.back().explained;
  // an explanation under which the motions still do not agree explains nothing; both streams inverted may
  if (!explains(final, options)) {
    if (std::optional<Finding> both = both_inverted(evidence, options);
        both && both->certain && both->improvement > options.overwhelming)
      findings.push_back(worded_reading(std::move(*both), {}, {}));
    return findings;
  }
  const std::optional<UnexplainedPart> left_out = left_out_by(final);
  const bool as_given = best.code.empty() && best.scale == 1 && clocks.empty();
  if (!as_given && left_out && !explains_the_rest(given, final, *left_out, options)) return findings;
  const Comparison overall = compare(given, final);
  const bool certain = overall.gain >= options.gain;
  // of which stream the axes are wrong may be open, not that they are
  const bool open = reading.twin && !reading.twin->code.starts_with("axes_");
  const auto add = [&](Finding finding) {
    finding.T_a_b = to_pose(final.fit.T);
    findings.push_back(std::move(finding));
  };
  const auto is_certain = [&](const Explanation& one) {
    return certain && !open && !turns_within_tolerance(one, options);
  };
  if (!best.code.empty())
    add(worded_reading(finding_of(best, overall, is_certain(best)), best.read_a, best.read_b));
  if (reading.twin)
    findings.push_back(worded_reading(
        finding_of(*reading.twin, compare(given, reading.twin->explained), is_certain(*reading.twin)),
        reading.twin->read_a, reading.twin->read_b));
  if (best.scale != 1) {
    Explanation explanation = best;
    explanation.explained.fit.T = final.fit.T;
    findings.push_back(scale_finding(explanation, overall, certain, evidence, options));
  }
  if (!clocks.empty()) {
    const Explanation& clock = clocks.back();
    Finding finding = finding_of(clock, overall, certain);
    const bool drift = clock.code == "clock_drift";
    finding.value = drift ? clock.clock.rate : clock.clock.offset;
    add(worded_clock(std::move(finding), clock.clock));
  }
  if (left_out) name_part(*left_out, findings);
  if (!findings.empty()) return findings;

  // the same mistake in both files may leave nearly no trace: all that fits is named
  if (std::optional<Finding> orders = both_orders(evidence, options)) findings.push_back(*std::move(orders));
  if (const std::optional<Explanation>& inverse = reading.inverse_rotations)
    findings.push_back(worded_reading(finding_of(*inverse, compare(given, inverse->explained), false),
                                      inverse->read_a, inverse->read_b));
  if (const std::optional<Explanation>& turned = reading.turned_axes; turned && findings.empty())
    findings.push_back(worded_reading(finding_of(*turned, compare(given, turned->explained), false),
                                      turned->read_a, turned->read_b));
  if (findings.empty())
    if (std::optional<Finding> both = both_inverted(evidence, options))
      findings.push_back(worded_reading(std::move(*both), {}, {}));
  return findings;
}

std::optional<Finding> wrong_scale(const Evidence& evidence, const DiagnosisOptions& options) {
  const Explanation& scaled = evidence.scaled;
  const double size = std::abs(std::log(scaled.scale));
  if (!explains(scaled.explained, options)) return std::nullopt;
  // a scale fitted to outliers leaves the other motions worse off
  const Comparison comparison = compare(evidence.given.explained, scaled.explained);
  if (!(comparison.gain >= options.least_gain)) return std::nullopt;
  const std::size_t independent = evidence.instants.size() / static_cast<std::size_t>(evidence.stride);
  const std::optional<double> stddev = stddev_of_log_scale(
      evidence.given.explained.motions, {scaled.scale, scaled.explained}, independent, options.scale_check);
  if (!stddev || size < options.scale_check.sigmas * *stddev) return std::nullopt;
  return shown_by_few(evidence, comparison, size / *stddev, options);
}

namespace {

/// By how many of its standard deviations the scale of motions of all lengths differs from one; 0 where it is
/// not shown, or another one than that of the long motions.
double sigmas_of_drive(const Evidence& evidence, const PairingOptions& pairing,
                       const DiagnosisOptions& options) {
  const double of_long = std::log(evidence.scaled.scale);
  DriveScaleOptions of_b;
  of_b.scale.side = Side::b;
  const std::optional<ScaleSolution> drive =
      estimate_scale(evidence.streams.a, evidence.streams.b, pairing, of_b);
  if (!drive || !drive->observable || !drive->certified) return 0;
  const double size = std::log(drive->scale), stddev = drive->stddev / drive->scale;
  const bool large = std::abs(of_long) >= options.scale_check.least;
  if ((large && !(std::abs(size) >= options.scale_check.least)) || !(stddev > 0) ||
      !(std::abs(size - of_long) <= options.scale_check.agree * std::abs(of_long)))
    return 0;
  return std::abs(size) / stddev;
}

}  // namespace

std::optional<Finding> wrong_scale_of_drive(const Evidence& evidence, const PairingOptions& pairing,
                                            const DiagnosisOptions& options) {
  const ScaleCheckOptions& check = options.scale_check;
  if (!explains(evidence.scaled.explained, options)) return std::nullopt;
  const double sigmas = sigmas_of_drive(evidence, pairing, options);
  const Comparison comparison = compare(evidence.given.explained, evidence.scaled.explained);
  if (std::abs(std::log(evidence.scaled.scale)) >= check.least && sigmas >= check.sigmas_of_drive)
    return shown_by_few(evidence, comparison, sigmas, options);
  if (!(comparison.gain > 0) || !(sigmas >= check.sigmas)) return std::nullopt;
  return scale_finding(evidence.scaled, comparison, false, evidence, options);
}

}  // namespace egocal::detail
