// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/best_reading.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnosis/explanations/both_streams.hpp"
#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/contents/forward.hpp"
#include "diagnosis/explanations/contents/without_lever_arms.hpp"
#include "diagnosis/explanations/lengths/scale.hpp"
#include "diagnosis/motions/axes.hpp"

namespace egocal::detail {

namespace {

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

/// Whether a reading fits no worse in metres: far from the origin any residual is a small part of an inverse
/// motion. A scale that shrinks b hides it, unless the drive as given is not that near at its own best scale.
bool fits_in_metres(const Evidence& evidence, const Explanation& as_is, const Explanation& scaled) {
  const Explained& given = evidence.given.explained;
  return loss_in_metres(given, scaled.explained) <= 0 &&
         (loss_in_metres(given, as_is.explained) <= 0 ||
          loss_in_metres(evidence.scaled.explained, scaled.explained) <= -decisive_loss);
}

/// Two mistakes in one stream, which are looked for where none alone explains the drive: of those that do.
std::vector<Ranked> combined_readings(const Evidence& evidence, const DiagnosisOptions& options) {
  std::vector<Ranked> readings;
  for (const Candidate& candidate : combined_mistakes()) {
    Explanation here = explained(evidence, candidate.code, candidate.a, candidate.b, options);
    if (here.explained.motions.all.empty()) continue;
    Explanation scaled = with_scale(here, options);
    if (explains(scaled.explained, options) && fits_in_metres(evidence, here, scaled))
      readings.push_back({std::move(here), std::move(scaled)});
  }
  return readings;
}

bool inverts_one(const Explanation& explanation) {
  return explanation.code == "inverted_a" || explanation.code == "inverted_b";
}

/// Whether x is preferred to y: the reading under which a vehicle travels forward, or else the one that fits
/// better. Twins, which are each other with both streams inverted, are compared in metres.
bool preferred(const Explanation& x, const Explanation& y, const HeadingOptions& options) {
  const Heading of_x = heading(x.explained.motions), of_y = heading(y.explained.motions);
  const bool x_forward = forward(of_x, options), y_forward = forward(of_y, options);
  if (x_forward != y_forward) return x_forward;
  if (inverts_one(x) && inverts_one(y)) return loss_in_metres(x.explained, y.explained) > 0;
  return compare(y.explained, x.explained).ratio > 1;
}

/// Whether the motions show that the scale of b is not one. Where both sensors turn about one point any scale
/// has a lever arm that fits, and the best one only balances the noise of both.
bool shows_scale(const Evidence& evidence, const Ranked& reading, const DiagnosisOptions& options) {
  const std::size_t independent = evidence.instants.size() / static_cast<std::size_t>(evidence.stride);
  const std::optional<double> stddev =
      stddev_of_log_scale(reading.as_is.explained.motions, {reading.scaled.scale, reading.scaled.explained},
                          independent, options.scale_check);
  return stddev && std::abs(std::log(reading.scaled.scale)) > options.scale_check.sigmas * *stddev;
}

/// The best of the common mistakes; as given unless another one is clearly better.
BestReading best_common_mistake(const Evidence& evidence, const DiagnosisOptions& options) {
  Ranked best{evidence.given, evidence.scaled};
  std::optional<Explanation> twin;
  std::vector<Ranked> readings = best_readings(evidence, options);
  const auto clearly_better = [&](const Ranked& reading) {
    return better(compare(evidence.scaled.explained, reading.scaled.explained), 0.01, options);
  };
  const auto fits = [&](const Ranked& reading) { return explains(reading.scaled.explained, options); };
  if (!explains(evidence.scaled.explained, options) && std::none_of(readings.begin(), readings.end(), fits))
    for (Ranked& combined : combined_readings(evidence, options)) readings.push_back(std::move(combined));
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

bool turns_a_little(const PoseReading& reading) {
  return !is_permutation(reading.axes) && turn_of(reading.axes).norm() < TurnedAxesOptions().small;
}

double least_gain_of(const PoseReading& reading, const DiagnosisOptions& options) {
  return turns_a_little(reading) ? TurnedAxesOptions().gain_of_small : options.least_gain;
}

struct CommonAxes {
  std::optional<Explanation> best, possible;
};

/// The same wrong axes in both files, the one that fits best: what is left may agree nearly where both
/// sensors stand alike. And inverse rotations that are possible.
CommonAxes common_axes(const Evidence& evidence, const DiagnosisOptions& options) {
  const CommonAxesOptions least;
  const Explained& given = evidence.given.explained;
  CommonAxes result;
  double gain_of_possible = 0;
  for (const PoseReading& reading :
       common_axes_readings(evidence.instants, evidence.stride, options.motions.first_look, options)) {
    Explanation here = explained(evidence, "axes_both", reading, reading, options);
    if (here.explained.motions.all.empty() || !explains(here.explained, options)) continue;
    const Comparison comparison = compare(given, here.explained);
    // as where both are inverted, noise alone may suit the wrong reading better, and far from the origin any
    // residual is a small part of its motions
    if (reading.conjugate) {
      const double loss = loss_in_metres(given, here.explained);
      const bool turned_too = !reading.axes.isIdentity(0);
      if (!turned_too && better(comparison, least.possible_gain, least.possible_sigmas) &&
          loss <= -least.possible_gain_in_metres && comparison.gain > gain_of_possible) {
        result.possible = here;
        gain_of_possible = comparison.gain;
      }
      if (comparison.gain < (turned_too ? decisive_loss : least.gain) ||
          loss > -(turned_too ? decisive_loss : least.gain_in_metres))
        continue;
    }
    if (comparison.gain < least_gain_of(reading, options)) continue;
    // simple readings come first
    if (!result.best || compare(result.best->explained, here.explained).gain > options.alike)
      result.best = std::move(here);
  }
  return result;
}

/// Positions of one file in other axes than its rotations. Exchanged columns are what people do; turned axes
/// have three more unknowns and must explain clearly more. Turned axes of one stream are up to the lever arm
/// those of the other one turned likewise: where both fit better, both are named.
BestReading best_axes(const Evidence& evidence, const BestReading& given, const DiagnosisOptions& options) {
  std::optional<Explanation> exchanged, turned, turned_other, possible;
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
      const Comparison comparison = compare(given.best.explained, here.explained);
      if (turns_a_little(reading) && !reading.conjugate && here.scale == 1 &&
          better(comparison, TurnedAxesOptions().possible_gain_of_small, options) &&
          fits_better(possible, here) && but_for_lever_arms(here))
        possible = here;
      if (!better(comparison, least_gain_of(reading, options), options) || !but_for_lever_arms(here))
        continue;
      std::optional<Explanation>& best = is_permutation(reading.axes) ? exchanged : turned_here;
      if (fits_better(best, here)) best = here;
    }
    if (!turned_here) continue;
    std::swap(turned, turned_other);
    std::swap(turned, turned_here);
    if (turned_other && !fits_better(turned_other, *turned)) std::swap(turned, turned_other);
  }
  // a lever arm that is long tells the two streams apart
  if (turned_other && compare(turned_other->explained, turned->explained).gain > options.alike)
    turned_other.reset();
  BestReading result = given;
  if (exchanged) result = {*exchanged, mirrored_twin(evidence, *exchanged, options)};
  if (turned && better(compare(result.best.explained, turned->explained), options.gain, options))
    result = {*turned, turned_other};
  CommonAxes common = common_axes(evidence, options);
  if (std::optional<Explanation>& both = common.best) {
    const Comparison comparison = compare(result.best.explained, both->explained);
    // columns that one program exchanged in both files are simpler than axes of one file that are turned
    const bool simpler = is_permutation(both->read_b.axes) && turned && result.best.code == turned->code &&
                         !is_permutation(result.best.read_a.axes * result.best.read_b.axes);
    if (better(comparison, options.gain, options))
      result = {*std::move(both)};
    else if (simpler && comparison.gain > -options.alike)
      result = {*std::move(both), result.best};
  }
  result.inverse_rotations = std::move(common.possible);
  result.turned_axes = std::move(possible);
  return result;
}

}  // namespace

BestReading best_reading(const Evidence& evidence, const DiagnosisOptions& options) {
  return best_axes(evidence, best_common_mistake(evidence, options), options);
}

}  // namespace egocal::detail
