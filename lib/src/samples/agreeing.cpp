// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/agreeing.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/statistics/median.hpp"
#include "samples/adding_samples.hpp"
#include "samples/half_turns.hpp"
#include "samples/trimmed_search.hpp"

namespace egocal::detail {

namespace {

double turn(const DualQuaternion& from, const DualQuaternion& to) {
  return rotation_angle(quaternion_product(quaternion_conjugate(from.real), to.real));
}

/// Standard deviation of a rotation [rad] as the motions show it without any answer: their angles in a and in
/// b are equal except for noise. From the fifth of the motions that agrees best, as half of them may have a
/// wrong end.
double congruent_noise(const SampleSet& set, double least) {
  constexpr double normal_fifth = 0.2533;  // mathematics: the fifth of absolute normal values
  std::vector<double> differences;
  const std::size_t n = set.size();
  for (const std::size_t step : {n / 2, n / 3})
    for (std::size_t i = 0; i < n; ++i) {
      const PoseSample &from = set.sample(i), &to = set.sample((i + step) % n);
      differences.push_back(std::abs(turn(from.a, to.a) - turn(from.b, to.b)));
    }
  const double fifth = order_statistic_in_place(differences, differences.size() / 5);
  return std::max(least, fifth / (normal_fifth * std::sqrt(2.0)));
}

/// Whether a search from triples of samples cannot find anything better.
bool beyond_doubt(const SampleSet& set, const TrimmedFit& trimmed, const AgreeingSamples& agreeing,
                  const AgreeingOptions& tuning) {
  if (static_cast<double>(agreeing.chosen.size()) < tuning.most_samples * static_cast<double>(set.size()))
    return false;
  const SampleNoise& noise = agreeing.fit.noise;
  return std::sqrt(noise.rotation) <= tuning.as_good * congruent_noise(set, tuning.least_noise) &&
         trimmed.fit.noise.translation >= tuning.least_trimmed * noise.translation;
}

}  // namespace

SampleFit fit_of_all(const SampleSet& set, const SampleOptions& options) {
  const FitSettings settings = settings_of(options);
  constexpr std::size_t few = 6;  // beyond, the choices of signs are too many
  if (set.size() <= few) return fit_of_few(set, settings);
  const Indices all = all_of(set);
  SampleFit best = fit_samples(set, all, settings);
  for (const SampleFit& start : half_turned(set, all, best)) {
    FitSettings from_there = settings;
    from_there.start = start;
    SampleFit other = fit_samples(set, all, from_there);
    if (clearly_better(other, best)) best = std::move(other);
  }
  return best;
}

AgreeingSamples find_agreeing(const SampleSet& set, const SampleOptions& options,
                              const AgreeingOptions& tuning) {
  // one pose in two samples may make one of them wrong: the others are still as many as in least_to_judge
  const bool few = set.size() < options.least_to_judge || set.units() + 1 < options.least_to_judge;
  if (!options.robust || few) return {all_of(set), fit_of_all(set, options)};
  const TrimmedSearch search(set, options, tuning);
  if (set.size() >= tuning.least_for_congruence) {
    const TrimmedFit trimmed = search.from_all();
    AgreeingSamples agreeing = with_added_samples(set, trimmed, options, tuning);
    if (beyond_doubt(set, trimmed, agreeing, tuning)) return agreeing;
  }
  return with_added_samples(set, search.best(), options, tuning);
}

}  // namespace egocal::detail
