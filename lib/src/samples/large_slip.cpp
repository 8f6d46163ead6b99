// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/large_slip.hpp"

#include <algorithm>
#include <cmath>

#include "samples/slip.hpp"
#include "samples/trimmed_search.hpp"

namespace egocal::detail {

namespace {

/// The variance of both parts together, each with an answer of its own.
SampleNoise pooled(const SampleFit& before, const SampleFit& after) {
  const double dof = before.dof + after.dof;
  const auto mean = [&](double one, double other) { return (before.dof * one + after.dof * other) / dof; };
  return {mean(before.noise.rotation, after.noise.rotation),
          mean(before.noise.translation, after.noise.translation)};
}

struct Division {
  std::size_t at = 0;  ///< in the order given, first sample after it
  double gain = 0;     ///< of the variance
  SampleFit before, after;
};

struct Change {
  double shift = 0, turn = 0;  ///< [m, rad]
  double size(double length) const { return turn + shift / length; }
};
Change change_of(const DualQuaternion& from, const DualQuaternion& to) {
  const Pose one = to_pose(from), other = to_pose(to);
  return {(other.translation - one.translation).norm(), one.rotation.angularDistance(other.rotation)};
}

/// The division of the samples at this place. A part that is empty or has too few units: a gain of 0.
Division divided(const SampleSet& set, const SampleFit& all, const std::vector<std::size_t>& order,
                 std::size_t at, const FitSettings& settings, const LargeSlipOptions& tuning) {
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(at);
  std::vector<std::size_t> first(order.begin(), middle), second(middle, order.end());
  if (set.units_among(first) < tuning.least_part || set.units_among(second) < tuning.least_part) return {};
  // the order of the rows changes no bit of a fit
  std::sort(first.begin(), first.end());
  std::sort(second.begin(), second.end());
  Division division{at, 0, fit_samples(set, first, settings), fit_samples(set, second, settings)};
  if (division.before.dof > 0 && division.after.dof > 0)
    division.gain = improvement(all.noise, pooled(division.before, division.after));
  return division;
}

/// Places evenly spread, then those around the best one: with a single sample in the wrong part the gain is a
/// fraction of what it is without.
Division best_division(const SampleSet& set, const SampleFit& all, const std::vector<std::size_t>& order,
                       const FitSettings& settings, const LargeSlipOptions& tuning) {
  Division best;
  const std::size_t n = order.size(), last = n - tuning.least_part;
  const std::size_t step = (n + tuning.most_places - 1) / tuning.most_places;
  const auto look_at = [&](std::size_t at) {
    Division division = divided(set, all, order, at, settings, tuning);
    if (division.gain > best.gain) best = std::move(division);
  };
  for (std::size_t at = tuning.least_part; at <= last; at += step) look_at(at);
  if (!(best.gain > 0)) return best;
  const std::size_t around = best.at;
  for (std::size_t at = std::max(tuning.least_part, around - std::min(around, step - 1));
       at <= std::min(last, around + step - 1); ++at)
    if (at != around) look_at(at);
  return best;
}

Finding worded(const SampleSet& set, const Division& division, std::size_t given, const SampleNames& names,
               bool metres, bool certain) {
  const Change of_camera = change_of(division.before.X, division.after.X),
               of_target = change_of(division.before.Y, division.after.Y);
  const bool target = of_target.size(set.length()) > of_camera.size(set.length());
  const Change& change = target ? of_target : of_camera;
  return worded_slip({given, target, change.shift, change.turn, division.gain, to_pose(division.after.X)},
                     names, metres, certain);
}

/// Where the samples that count end, or begin, and no other one lies beyond; 0: nowhere.
std::size_t where_all_are_rejected(const std::vector<std::size_t>& chosen,
                                   const std::vector<std::size_t>& order) {
  const auto counts = [&](std::size_t k) {
    return std::binary_search(chosen.begin(), chosen.end(), order[k]);
  };
  std::size_t at = 0;
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (counts(k) == counts(k - 1)) continue;
    if (at > 0) return 0;
    at = k;
  }
  return at;
}

std::optional<Finding> rejected_from_a_row_on(const SampleSet& set, const AgreeingSamples& agreeing,
                                              const std::vector<std::size_t>& order,
                                              const std::vector<std::size_t>& given, const SampleNames& names,
                                              const SampleOptions& options, const LargeSlipOptions& tuning) {
  const std::size_t at = where_all_are_rejected(agreeing.chosen, order);
  if (at == 0) return std::nullopt;
  const FitSettings settings = settings_of(options);
  const Division division =
      divided(set, fit_samples(set, all_of(set), settings), order, at, settings, tuning);
  if (!(division.gain > tuning.least_gain_of_rejected)) return std::nullopt;
  return worded(set, division, given[at], names, options.diagnosis.unit == LengthUnit::metres, true);
}

}  // namespace

std::optional<Finding> find_large_slip(const SampleSet& set, const AgreeingSamples& agreeing,
                                       const std::vector<std::size_t>& order,
                                       const std::vector<std::size_t>& given, const SampleNames& names,
                                       const SampleOptions& options, const LargeSlipOptions& tuning) {
  if (set.units() < 2 * tuning.least_part) return std::nullopt;
  if (std::optional<Finding> found =
          rejected_from_a_row_on(set, agreeing, order, given, names, options, tuning))
    return found;
  if (!(largest_noise(set, agreeing.fit.noise) > tuning.least_noise)) return std::nullopt;
  const Division division = best_division(set, agreeing.fit, order, settings_of(options), tuning);
  if (!(division.gain > tuning.least_gain)) return std::nullopt;
  return worded(set, division, given[division.at], names, options.diagnosis.unit == LengthUnit::metres,
                division.gain > tuning.certain_gain);
}

}  // namespace egocal::detail
