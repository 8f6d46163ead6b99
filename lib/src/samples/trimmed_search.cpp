// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/trimmed_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "samples/half_turns.hpp"
#include "statistics/draws.hpp"

namespace egocal::detail {

Indices all_of(const SampleSet& set) {
  Indices indices(set.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  return indices;
}

FitSettings settings_of(const SampleOptions& options) {
  FitSettings settings;
  settings.prior_log_ratio = options.prior_log_ratio;
  return settings;
}

double in_variances(const SampleSet& set, std::size_t i, const SampleFit& fit) {
  const SquaredResidual residual = squared_residual(set, i, fit);
  return residual.rotation / fit.noise.rotation + residual.translation / fit.noise.translation;
}

TrimmedSearch::TrimmedSearch(const SampleSet& set, const SampleOptions& options,
                             const AgreeingOptions& tuning)
    : set_(set), options_(options), tuning_(tuning) {
  const auto part_of = [&](std::size_t n) {
    return std::max<std::size_t>(
        4, static_cast<std::size_t>(std::ceil(options.least_agreeing * static_cast<double>(n))));
  };
  kept_ = part_of(set.size());
  kept_units_ = part_of(set.units());
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set.unit(i) == members_.size()) members_.emplace_back();
    members_[set.unit(i)].push_back(i);
  }
}

TrimmedFit TrimmedSearch::from_all() const {
  return or_half_turned(concentrated(first_fit(all_of(set_)), tuning_.steps_from_all));
}

TrimmedFit TrimmedSearch::best() const {
  std::vector<TrimmedFit> found;
  for (const Indices& start : starts()) found.push_back(concentrated(first_fit(start), tuning_.first_steps));
  const auto smaller = [](const TrimmedFit& x, const TrimmedFit& y) { return x.size < y.size; };
  std::stable_sort(found.begin(), found.end(), smaller);
  TrimmedFit best = found.front();
  for (std::size_t i = 0; i < std::min(tuning_.most_followed, found.size()); ++i) {
    TrimmedFit here = concentrated(found[i].fit, tuning_.last_steps);
    if (here.size < best.size) best = std::move(here);
  }
  return or_half_turned(std::move(best));
}

/// The same with X times half a turn, if the rotations leave it open and the positions fit better.
TrimmedFit TrimmedSearch::or_half_turned(TrimmedFit trimmed) const {
  for (const SampleFit& other : half_turned(set_, trimmed.chosen, trimmed.fit)) {
    TrimmedFit here = concentrated(other, tuning_.last_steps);
    if (here.size < trimmed.size - tuning_.least_gain) trimmed = std::move(here);
  }
  return trimmed;
}

SampleFit TrimmedSearch::first_fit(const Indices& start) const {
  FitSettings settings = settings_of(options_);
  // two motions say nothing of noise
  settings.noise = SampleNoise{1, set_.length() * set_.length()};
  settings.most_rounds = tuning_.rounds_on_the_way;
  settings.precision = FitPrecision::on_the_way;
  return fit_samples(set_, start, settings);
}

/// Triples of different units, all of them or drawn.
std::vector<Indices> TrimmedSearch::starts() const {
  std::vector<Indices> starts{all_of(set_)};
  const std::size_t n = set_.size();
  if (n * (n - 1) * (n - 2) / 6 <= static_cast<std::size_t>(options_.starts)) {
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        for (std::size_t k = j + 1; k < n; ++k)
          if (set_.units_among(Indices{i, j, k}) == 3) starts.push_back({i, j, k});
    return starts;
  }
  detail::Draws draws;
  const auto draw = [&] {
    const Indices& unit = members_[draws.below(members_.size())];
    return unit.size() == 1 ? unit[0] : unit[draws.below(unit.size())];
  };
  while (starts.size() <= static_cast<std::size_t>(options_.starts)) {
    Indices triple{draw(), draw(), draw()};
    std::sort(triple.begin(), triple.end());
    if (triple[0] != triple[1] && triple[1] != triple[2] && set_.units_among(triple) == 3)
      starts.push_back(std::move(triple));
  }
  return starts;
}

/// The first kept_ samples, and more until they belong to kept_units_ units.
Indices TrimmedSearch::first_of(const std::vector<std::pair<double, std::size_t>>& order) const {
  Indices chosen;
  std::vector<bool> met(set_.units(), false);
  std::size_t units = 0;
  for (const auto& [size, i] : order) {
    if (chosen.size() >= kept_ && units >= kept_units_) break;
    chosen.push_back(i);
    units += met[set_.unit(i)] ? 0 : 1;
    met[set_.unit(i)] = true;
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// Concentration steps: fits, keeps the samples that fit best, and repeats until they stay the same.
TrimmedFit TrimmedSearch::concentrated(SampleFit fit, int steps) const {
  TrimmedFit trimmed;
  for (int step = 0; step < steps; ++step) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < set_.size(); ++i) {
      order.emplace_back(in_variances(set_, i, fit), i);
    }
    std::sort(order.begin(), order.end());
    Indices chosen = first_of(order);
    const bool same = chosen == trimmed.chosen;
    if (same) break;
    trimmed.chosen = std::move(chosen);
    FitSettings settings = settings_of(options_);
    settings.start = fit;
    settings.most_rounds = tuning_.rounds_on_the_way;
    settings.precision = FitPrecision::on_the_way;
    fit = fit_samples(set_, trimmed.chosen, settings);
  }
  SquaredResidual sum;
  for (const std::size_t i : trimmed.chosen) {
    const SquaredResidual squares = squared_residual(set_, i, fit);
    sum.rotation += squares.rotation;
    sum.translation += squares.translation;
  }
  trimmed.size = std::log(sum.rotation + tuning_.nothing) +
                 std::log(sum.translation / (set_.length() * set_.length()) + tuning_.nothing);
  trimmed.fit = std::move(fit);
  return trimmed;
}

}  // namespace egocal::detail
