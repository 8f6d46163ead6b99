// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "diagnosis/axes.hpp"
#include "diagnosis/both_streams.hpp"
#include "diagnosis/common_mistakes.hpp"
#include "diagnosis/forward.hpp"
#include "diagnosis/large_move.hpp"
#include "diagnosis/scale.hpp"
#include "diagnosis/without_lever_arms.hpp"
#include "diagnosis/wording.hpp"

namespace egocal::detail {

namespace {

Finding scale_finding(const Explanation& explanation, const Comparison& comparison, bool certain,
                      const DiagnosisOptions& options) {
  const double power = std::round(std::log10(explanation.scale) / 3);
  const bool units = power != 0 && std::abs(std::log(explanation.scale / std::pow(1000, power))) <
                                       options.scale.unit_tolerance;
  Finding finding = finding_of(explanation, comparison, certain);
  finding.code = units ? "units" : "scale";
  finding.value = units ? std::pow(1000, power) : explanation.scale;
  finding = worded_scale(std::move(finding));
  // the answer is in the units of a: those of the longer stream are the wrong ones
  if (units && power > 0) finding.T_a_b->translation /= *finding.value;
  return finding;
}

/// Explanations by reading, the best first; all with a free scale, so that a camera without scale is not
/// taken for an inverted file.
struct Ranked {
  Explanation as_is, scaled;
};

std::vector<Ranked> best_readings(const Evidence& evidence, const DiagnosisOptions& options) {
  std::vector<std::pair<double, std::size_t>> looks;
  const std::vector<Candidate> candidates = common_mistakes();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (std::string_view(candidates[i].code) == "inverted_both") continue;  // decided by itself
    const Motions motions = motions_of(evidence.instants, candidates[i].a, candidates[i].b, evidence.stride,
                                       options.motions.first_look, options.motions);
    if (!motions.all.empty())
      looks.emplace_back(fit_with_scale(motions, options, Effort::look).explained.fit.typical, i);
  }
  std::sort(looks.begin(), looks.end());
  std::vector<Ranked> ranked;
  for (std::size_t i = 0; i < std::min(options.followed, looks.size()); ++i) {
    const Candidate& candidate = candidates[looks[i].second];
    Explanation here = explained(evidence, candidate.code, candidate.a, candidate.b, options);
    if (here.explained.motions.all.empty()) continue;
    Explanation scaled = with_scale(here, options);
    ranked.push_back({std::move(here), std::move(scaled)});
  }
  return ranked;
}

bool inverts_one(const Explanation& explanation) {
  return explanation.code == "inverted_a" || explanation.code == "inverted_b";
}

/// Of twins, which are each other with both streams inverted, the one under which a vehicle travels forward,
/// or the one that fits better in metres.
bool preferred(const Explanation& x, const Explanation& y, const HeadingOptions& options) {
  const Heading of_x = heading(x.explained.motions), of_y = heading(y.explained.motions);
  const bool x_forward = forward(of_x, options), y_forward = forward(of_y, options);
  if (x_forward != y_forward) return x_forward;
  if (inverts_one(x) && inverts_one(y)) return loss_in_metres(x.explained, y.explained) > 0;
  return compare(y.explained, x.explained).ratio > 1;
}

struct BestReading {
  Explanation best;
  std::optional<Explanation> twin;  ///< fits as well
};

/// Whether the motions show that the scale of b is not one. Where both sensors turn about one point any scale
/// has a lever arm that fits, and the best one only balances the noise of both.
bool shows_scale(const Evidence& evidence, const Ranked& reading, const DiagnosisOptions& options) {
  const std::size_t independent = evidence.instants.size() / static_cast<std::size_t>(evidence.stride);
  const std::optional<double> stddev =
      stddev_of_log_scale(reading.as_is.explained.motions, {reading.scaled.scale, reading.scaled.explained},
                          independent, options.scale_check);
  return stddev && std::abs(std::log(reading.scaled.scale)) > options.scale_check.sigmas * *stddev;
}

/// The best single reading; as given unless another one is clearly better.
BestReading best_reading(const Evidence& evidence, const DiagnosisOptions& options) {
  Ranked best{evidence.given, evidence.scaled};
  std::optional<Explanation> twin;
  std::vector<Ranked> readings = best_readings(evidence, options);
  const auto clearly_better = [&](const Ranked& reading) {
    return better(compare(evidence.scaled.explained, reading.scaled.explained), 0.01, options);
  };
  const auto fits = [&](const Ranked& reading) { return explains(reading.scaled.explained, options); };
  const auto any_inverted = [&](const auto& holds) {
    return std::any_of(readings.begin(), readings.end(),
                       [&](const Ranked& reading) { return inverts_one(reading.as_is) && holds(reading); });
  };
  // of twins one may be clear by the test and both fit
  const bool one_is_better = any_inverted(clearly_better), one_fits = any_inverted(fits);
  for (Ranked& here : readings) {
    const bool inverted = inverts_one(here.as_is);
    if (!clearly_better(here) && !(one_is_better && inverted)) continue;
    if (inverted && one_fits && !fits(here)) continue;
    // where the streams as given agree: far from the origin any residual is a small part of an inverse motion
    if (inverted && explains(evidence.given.explained, options) &&
        loss_in_metres(evidence.given.explained, here.scaled.explained) > 0)
      continue;
    const Comparison against = compare(best.scaled.explained, here.scaled.explained);
    const bool first = best.as_is.code.empty();
    // twins are each other with both streams inverted: arms fit up to ten times better under the wrong one,
    // but not in metres
    const bool disagree =
        inverted && inverts_one(best.as_is) &&
        (against.gain > 0) == (loss_in_metres(best.scaled.explained, here.scaled.explained) > 0);
    const bool alike = !first && std::abs(against.gain) < (disagree ? decisive_loss : options.alike);
    if (first || (alike ? preferred(here.scaled, best.scaled, options.heading) : against.gain > 0))
      std::swap(best, here);
    if (alike)
      twin = here.as_is;
    else if (!first && against.gain > 0)
      twin.reset();
  }
  if (twin && forward(heading(best.scaled.explained.motions), options.heading) &&
      !forward(heading(twin->explained.motions), options.heading))
    twin.reset();
  if (twin && inverts_one(best.as_is) && inverts_one(*twin) &&
      loss_in_metres(best.as_is.explained, twin->explained) > decisive_loss)
    twin.reset();
  if (number_explains(compare(best.as_is.explained, best.scaled.explained), options) &&
      shows_scale(evidence, best, options))
    return {best.scaled, twin};
  return {best.as_is, twin};
}

/// Positions mirrored at the origin in one stream are those of the other one mirrored, for every rotation.
std::optional<Explanation> mirrored_twin(const Evidence& evidence, const Explanation& found,
                                         const DiagnosisOptions& options) {
  const bool in_b = std::string_view(found.code) == "axes_b";
  const PoseReading& reading = in_b ? found.read_b : found.read_a;
  if (reading.conjugate || reading.axes != -Eigen::Matrix3d::Identity()) return std::nullopt;
  Explanation twin = explained(evidence, in_b ? "axes_a" : "axes_b", in_b ? reading : PoseReading{},
                               in_b ? PoseReading{} : reading, options);
  return found.scale != 1 ? with_scale(twin, options) : twin;
}

double least_gain_of(const PoseReading& reading, const DiagnosisOptions& options) {
  const TurnedAxesOptions turned;
  const bool small = !is_permutation(reading.axes) && turn_of(reading.axes) < turned.small;
  return small ? turned.gain_of_small : options.least_gain;
}

/// The same wrong axes in both files, the one that fits best: what is left may agree nearly where both
/// sensors stand alike.
std::optional<Explanation> common_axes(const Evidence& evidence, const DiagnosisOptions& options) {
  const CommonAxesOptions least;
  std::optional<Explanation> best;
  for (const PoseReading& reading :
       common_axes_readings(evidence.instants, evidence.stride, options.motions.first_look, options)) {
    Explanation here = explained(evidence, "axes_both", reading, reading, options);
    if (here.explained.motions.all.empty() || !explains(here.explained, options)) continue;
    // as where both are inverted, noise alone may suit the wrong reading better, and far from the origin any
    // residual is a small part of its motions
    const Explained& given = evidence.given.explained;
    const bool turned_too = !reading.axes.isIdentity(0);
    if (reading.conjugate &&
        (compare(given, here.explained).gain < (turned_too ? decisive_loss : least.gain) ||
         loss_in_metres(given, here.explained) > -(turned_too ? decisive_loss : least.gain_in_metres)))
      continue;
    if (compare(given, here.explained).gain < least_gain_of(reading, options)) continue;
    // simple readings come first
    if (!best || compare(best->explained, here.explained).gain > options.alike) best = std::move(here);
  }
  return best;
}

/// Positions of one file in other axes than its rotations. Exchanged columns are what people do; turned axes
/// have three more unknowns and must explain clearly more. Turned axes of one stream are up to the lever arm
/// those of the other one turned likewise: where both fit better, both are named.
BestReading best_axes(const Evidence& evidence, const BestReading& given, const DiagnosisOptions& options) {
  std::optional<Explanation> exchanged, turned, turned_other;
  const double length = evidence.given.explained.motions.translation;
  std::optional<Explained> of_best, of_given;  // the same for every reading
  const auto but_for_lever_arms = [&](const Explanation& here) {
    // of lengths in the same unit
    std::optional<Explained>& against = here.scale != 1 ? of_best : of_given;
    if (!against)
      against = without_lever_arms(here.scale != 1 ? given.best.explained : evidence.given.explained, length);
    return better(compare(*against, without_lever_arms(here.explained, length)), options.least_gain,
                  LeverArmOptions{}.sigmas);
  };
  // the lengths of b may be wrong besides
  const bool with_scale_too = given.best.scale != 1 || !explains(given.best.explained, options);
  const auto fits_better = [](const std::optional<Explanation>& x, const Explanation& y) {
    return !x || compare(x->explained, y.explained).gain > 0;
  };
  for (const Side wrong : {Side::a, Side::b}) {
    std::optional<Explanation> turned_here;
    for (const PoseReading& reading :
         axes_readings(evidence.instants, wrong, evidence.stride, options.motions.first_look, options)) {
      const bool in_b = wrong == Side::b;
      Explanation here = explained(evidence, in_b ? "axes_b" : "axes_a", in_b ? PoseReading{} : reading,
                                   in_b ? reading : PoseReading{}, options);
      if (with_scale_too && !explains(here.explained, options)) {
        Ranked two{here, with_scale(here, options)};
        if (!explains(two.scaled.explained, options) || !shows_scale(evidence, two, options)) continue;
        here = std::move(two.scaled);
      }
      if (!better(compare(given.best.explained, here.explained), least_gain_of(reading, options), options) ||
          !but_for_lever_arms(here))
        continue;
      std::optional<Explanation>& best = is_permutation(reading.axes) ? exchanged : turned_here;
      if (fits_better(best, here)) best = here;
    }
    if (!turned_here) continue;
    std::swap(turned, turned_other);
    std::swap(turned, turned_here);
    if (turned_other && !fits_better(turned_other, *turned)) std::swap(turned, turned_other);
  }
  BestReading result = given;
  if (exchanged) result = {*exchanged, mirrored_twin(evidence, *exchanged, options)};
  if (turned && better(compare(result.best.explained, turned->explained), options.gain, options))
    result = {*turned, turned_other};
  if (std::optional<Explanation> both = common_axes(evidence, options)) {
    const Comparison comparison = compare(result.best.explained, both->explained);
    // columns that one program exchanged in both files are simpler than axes of one file that are turned
    const bool simpler = is_permutation(both->read_b.axes) && turned && result.best.code == turned->code &&
                         !is_permutation(result.best.read_a.axes * result.best.read_b.axes);
    if (better(comparison, options.gain, options))
      result = {*std::move(both), {}};
    else if (simpler && comparison.gain > -options.alike)
      result = {*std::move(both), result.best};
  }
  return result;
}

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
  const double length = 1e-6 * static_cast<double>(streams.a.back().time_us - streams.a.front().time_us);
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

/// What holds in a part of the drive only cures nothing by itself: a file whose convention changes on its
/// way.
void name_part(const Explained& final, std::vector<Finding>& findings) {
  LargeMoveOptions shortest;
  shortest.least_part = 1.0 / 6;  // two windows: every sixth of the drive was asked for by nothing else
  const std::optional<UnexplainedPart> part = unexplained_part(final.motions, final.fit.T, shortest);
  if (!part) return;
  for (Finding& finding : findings) {
    finding.message +=
        format(" This explains the drive without the part from %.0f to %.0f s after the start.", part->begin,
               part->end);
    finding.remedy = format("Calibrate the drive from %.0f to %.0f s separately; of the rest: %s",
                            part->begin, part->end, finding.remedy.c_str());
  }
}

}  // namespace

Evidence gather(const Trajectory& a, const Trajectory& b, const ClockModel& clock, double max_gap,
                const DiagnosisOptions& options) {
  Evidence evidence{turning_of(a),
                    turning_of(b),
                    {a, b, {}, {}, max_gap, 1, options, {}, {}},
                    clock,
                    synchronised(a, b, clock, max_gap, 1, options.motions),
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
  int longer = n;
  for (int stride = std::max(1, n / 32), looks = 0; looks < 4; ++looks) {
    // short motions hold fewer wrong poses, the shortest much noise: only where nearly nothing else is left
    const double clearly_less = longer < 4 ? 0.1 : 0.8;
    for (const Candidate& candidate : readings) {
      const Motions motions = motions_of(evidence.instants, candidate.a, candidate.b, stride,
                                         options.motions.first_look, options.motions);
      if (motions.all.empty()) continue;
      const double typical = quick_fit(motions, options.fit).typical;
      if (typical < clearly_less * least) {
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

  BestReading reading = best_axes(evidence, best_reading(evidence, options), options);
  Explanation best = reading.best;
  // a clock that is off can look like anything: it is tried on the streams as given, too
  std::vector<Explanation> clocks = with_clock(evidence, evidence.given, options);
  if (!clocks.empty() && !better(compare(clocks.back().explained, best.explained), options.gain, options)) {
    best = evidence.given;
    reading.twin.reset();
  } else if (!best.code.empty() || best.scale != 1)
    clocks = with_clock(evidence, best, options);

  const Explained& final = clocks.empty() ? best.explained : clocks.back().explained;
  // an explanation under which the motions still do not agree explains nothing
  if (!explains(final, options)) return findings;
  const Comparison overall = compare(given, final);
  const bool certain = overall.gain >= options.gain;
  // of which stream the axes are wrong may be open, not that they are
  const bool open = reading.twin && !reading.twin->code.starts_with("axes_");
  const auto add = [&](Finding finding) {
    finding.T_a_b = to_pose(final.fit.T);
    findings.push_back(std::move(finding));
  };
  if (!best.code.empty())
    add(worded_reading(finding_of(best, overall, certain && !open), best.read_a, best.read_b));
  if (reading.twin)
    findings.push_back(
        worded_reading(finding_of(*reading.twin, compare(given, reading.twin->explained), certain && !open),
                       reading.twin->read_a, reading.twin->read_b));
  if (best.scale != 1) {
    Explanation explanation = best;
    explanation.explained.fit.T = final.fit.T;
    findings.push_back(scale_finding(explanation, overall, certain, options));
  }
  if (!clocks.empty()) {
    const Explanation& clock = clocks.back();
    Finding finding = finding_of(clock, overall, certain);
    const bool drift = clock.code == "clock_drift";
    finding.value = drift ? clock.clock.rate : clock.clock.offset;
    add(worded_clock(std::move(finding), clock.clock));
  }
  name_part(final, findings);
  if (!findings.empty()) return findings;

  // the same mistake in both files may leave nearly no trace: all that fits is named
  for (const auto of_both : {both_orders, both_rotations_inverse})
    if (std::optional<Finding> finding = of_both(evidence, options)) findings.push_back(*std::move(finding));
  if (findings.empty())
    if (std::optional<Finding> both = both_inverted(evidence, options))
      findings.push_back(worded_reading(std::move(*both), {}, {}));
  return findings;
}

std::optional<Finding> wrong_scale(const Evidence& evidence, const DiagnosisOptions& options) {
  const Explanation& scaled = evidence.scaled;
  const double size = std::abs(std::log(scaled.scale));
  if (!(size >= options.scale_check.least)) return std::nullopt;
  if (!explains(scaled.explained, options)) return std::nullopt;
  // a scale fitted to outliers leaves the other motions worse off
  const Comparison comparison = compare(evidence.given.explained, scaled.explained);
  if (!(comparison.gain >= options.least_gain)) return std::nullopt;
  const std::size_t independent = evidence.instants.size() / static_cast<std::size_t>(evidence.stride);
  const std::optional<double> stddev = stddev_of_log_scale(
      evidence.given.explained.motions, {scaled.scale, scaled.explained}, independent, options.scale_check);
  if (!stddev || size < options.scale_check.sigmas * *stddev) return std::nullopt;
  Finding finding = scale_finding(scaled, comparison, true, options);
  if (finding.code == "scale" && comparison.gain < options.gain)
    finding.message = format(
        "The lengths of b times %.4g fit those of a: few motions show it, but by %.0f standard deviations.",
        scaled.scale, size / *stddev);
  return finding;
}

}  // namespace egocal::detail
