// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/agreeing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

#include "samples/half_turns.hpp"
#include "statistics/distributions.hpp"
#include "statistics/median.hpp"

namespace egocal::detail {

namespace {

using Indices = std::vector<std::size_t>;

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

/// Samples trimmed to those that fit best, and what their fit is worth.
struct Trimmed {
  Indices chosen;
  SampleFit fit;
  double size = 0;  ///< logarithm of the squared residuals of rotation times those of position: has no unit
};

class Search {
 public:
  Search(const SampleSet& set, const SampleOptions& options, const AgreeingOptions& tuning)
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

  /// The samples that fit best, beginning with the fit of all.
  Trimmed from_all() const {
    return or_half_turned(concentrated(first_fit(all_of(set_)), tuning_.steps_from_all));
  }

  Trimmed best() const {
    std::vector<Trimmed> found;
    for (const Indices& start : starts())
      found.push_back(concentrated(first_fit(start), tuning_.first_steps));
    const auto smaller = [](const Trimmed& x, const Trimmed& y) { return x.size < y.size; };
    std::stable_sort(found.begin(), found.end(), smaller);
    Trimmed best = found.front();
    for (std::size_t i = 0; i < std::min(tuning_.most_followed, found.size()); ++i) {
      Trimmed here = concentrated(found[i].fit, tuning_.last_steps);
      if (here.size < best.size) best = std::move(here);
    }
    return or_half_turned(std::move(best));
  }

 private:
  /// The same with X times half a turn, where the rotations leave it open and the positions want it.
  Trimmed or_half_turned(Trimmed trimmed) const {
    for (const SampleFit& other : half_turned(set_, trimmed.chosen, trimmed.fit)) {
      Trimmed here = concentrated(other, tuning_.last_steps);
      if (here.size < trimmed.size - tuning_.least_gain) trimmed = std::move(here);
    }
    return trimmed;
  }

  SampleFit first_fit(const Indices& start) const {
    FitSettings settings = settings_of(options_);
    // two motions say nothing of noise
    settings.noise = SampleNoise{1, set_.length() * set_.length()};
    settings.most_rounds = tuning_.rounds_on_the_way;
    settings.precision = FitPrecision::on_the_way;
    return fit_samples(set_, start, settings);
  }

  /// Triples of different units, all of them or drawn.
  std::vector<Indices> starts() const {
    std::vector<Indices> starts{all_of(set_)};
    const std::size_t n = set_.size();
    if (n * (n - 1) * (n - 2) / 6 <= static_cast<std::size_t>(options_.starts)) {
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
          for (std::size_t k = j + 1; k < n; ++k)
            if (set_.units_among(Indices{i, j, k}) == 3) starts.push_back({i, j, k});
      return starts;
    }
    std::uint64_t drawn = 1;
    const auto draw_of = [&](std::size_t count) {
      drawn = 6364136223846793005u * drawn + 1442695040888963407u;  // Knuth's: the same draws every time
      return static_cast<std::size_t>((drawn >> 33) % count);
    };
    const auto draw = [&] {
      const Indices& unit = members_[draw_of(members_.size())];
      return unit.size() == 1 ? unit[0] : unit[draw_of(unit.size())];
    };
    while (starts.size() <= static_cast<std::size_t>(options_.starts)) {
      Indices triple{draw(), draw(), draw()};
      std::sort(triple.begin(), triple.end());
      if (triple[0] != triple[1] && triple[1] != triple[2] && set_.units_among(triple) == 3)
        starts.push_back(std::move(triple));
    }
    return starts;
  }

  /// The first kept_ of them, and more until they are of kept_units_ units.
  Indices first_of(const std::vector<std::pair<double, std::size_t>>& order) const {
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

  /// The samples that fit best, fitted, and again, until the same ones fit best.
  Trimmed concentrated(SampleFit fit, int steps) const {
    Trimmed trimmed;
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

  const SampleSet& set_;
  const SampleOptions& options_;
  const AgreeingOptions& tuning_;
  std::size_t kept_ = 0, kept_units_ = 0;
  std::vector<Indices> members_;  ///< of each unit
};

Indices with(const Indices& chosen, std::size_t one) {
  Indices more = chosen;
  more.insert(std::lower_bound(more.begin(), more.end(), one), one);
  return more;
}

/// What a sample that does not count yet would add to the cost.
struct Added {
  double probability = 1;  ///< that noise adds as much
  double squares = 0;      ///< in variances of the noise
};

Added added_by(const SampleSet& set, const Indices& chosen, const SampleFit& fit, std::size_t one,
               const AgreeingOptions& tuning) {
  FitSettings settings;
  settings.start = fit;
  settings.noise = fit.noise;
  settings.most_rounds = tuning.rounds_on_the_way;
  settings.precision = FitPrecision::on_the_way;
  const Indices and_one = with(chosen, one);
  const SampleFit more = fit_samples(set, and_one, settings);
  constexpr double dof_of_pose = 6;  // mathematics
  const bool of_a_unit = set.units_among(and_one) == set.units_among(chosen);
  const double dof = of_a_unit ? dof_of_pose : more.dof - fit.dof;
  if (!(dof > 0) || !(fit.dof > 0)) return {};
  const double squares = (more.cost - fit.cost) / std::max(fit.variance, tuning.least_variance);
  return {f_exceeded(squares / dof, dof, fit.dof), squares};
}

/// How much larger the variance is by the median of all samples than by the chosen ones, which fit best.
double underestimated(const SampleSet& set, const SampleFit& fit) {
  constexpr double median_of_six = 5.348;  // mathematics: chi-squared, rotation and position
  std::vector<double> squares;
  for (std::size_t i = 0; i < set.size(); ++i) {
    squares.push_back(in_variances(set, i, fit));
  }
  const double middle = order_statistic_in_place(squares, (squares.size() - 1) / 2);
  return std::max(1.0, middle / median_of_six);
}

/// Does noise explain a sample by its residual alone? A fit with it is no worse than this one.
class PlainTest {
 public:
  PlainTest(const SampleSet& set, const SampleFit& fit, const AgreeingOptions& tuning)
      : set_(set), fit_(fit), unremarkable_(tuning.unremarkable) {}

  bool agrees(std::size_t one) {
    constexpr double dof = 6;  // mathematics: of a pose
    if (!(fit_.dof > 0) || !(fit_.cost > 0)) return false;
    const double f = in_variances(set_, one, fit_) / dof / fit_.variance;
    // the probability falls with f: most samples are on a side that is known already
    if (f <= agreed_) return true;
    if (f >= disagreed_) return false;
    const bool agrees = f_exceeded(f, dof, fit_.dof) > unremarkable_;
    (agrees ? agreed_ : disagreed_) = f;
    return agrees;
  }

 private:
  const SampleSet& set_;
  const SampleFit& fit_;
  double unremarkable_;
  double agreed_ = 0, disagreed_ = std::numeric_limits<double>::infinity();
};

Indices others(const SampleSet& set, const Indices& chosen) {
  Indices result;
  auto next = chosen.begin();
  for (std::size_t i = 0; i < set.size(); ++i)
    if (next != chosen.end() && *next == i)
      ++next;
    else
      result.push_back(i);
  return result;
}

/// How far off a sample must be to be wrong, in variances of the noise, whatever its probability.
double heaviest_tail(const SampleSet& set, const SampleFit& fit, const SampleOptions& options) {
  return options.heaviest_tail * options.heaviest_tail * underestimated(set, fit);
}

/// The same among many: one more hardly moves the fit, so its residual is what it adds to the cost, and the
/// nearest of those that are not wrong are taken in together. Otherwise each round would try every sample by
/// a fit of all, and take in one.
Indices next_of_many(const SampleSet& set, const AgreeingSamples& agreeing, const SampleOptions& options,
                     const AgreeingOptions& tuning) {
  constexpr double dof = 6;  // mathematics: of a pose
  const SampleFit& fit = agreeing.fit;
  if (!(fit.dof > 0)) return {};
  const double variance = std::max(fit.variance, tuning.least_variance);
  std::vector<std::pair<double, std::size_t>> order;
  for (const std::size_t i : others(set, agreeing.chosen))
    order.emplace_back(in_variances(set, i, fit) / variance, i);
  std::sort(order.begin(), order.end());
  const auto probability = [&](double squares) { return f_exceeded(squares / dof, dof, fit.dof); };
  // the probability falls along the order
  const auto first_with_less = [&](double least) {
    return std::partition_point(order.begin(), order.end(),
                                [&](const auto& one) { return probability(one.first) > least; });
  };
  const double tail = heaviest_tail(set, fit, options);
  const auto beyond_tail =
      std::partition_point(order.begin(), order.end(), [&](const auto& one) { return one.first <= tail; });
  const auto unremarkable = first_with_less(tuning.unremarkable);
  const auto wrong = std::max(first_with_less(options.wrong_probability), beyond_tail);
  const auto batch =
      static_cast<std::ptrdiff_t>(std::ceil(tuning.at_once * static_cast<double>(agreeing.chosen.size())));
  const auto end = std::max(unremarkable, order.begin() + std::min(batch, wrong - order.begin()));
  Indices next;
  for (auto one = order.begin(); one != end; ++one) next.push_back(one->second);
  std::sort(next.begin(), next.end());
  return next;
}

/// Samples to add next, in order: those that noise explains, else the nearest one; empty where that is wrong.
Indices next_samples(const SampleSet& set, const AgreeingSamples& agreeing, const SampleOptions& options,
                     const AgreeingOptions& tuning) {
  if (set.size() > tuning.most_one_by_one) return next_of_many(set, agreeing, options, tuning);
  const Indices candidates = others(set, agreeing.chosen);
  Indices plain;
  PlainTest test(set, agreeing.fit, tuning);
  for (const std::size_t i : candidates)
    if (test.agrees(i)) plain.push_back(i);
  if (!plain.empty()) return plain;
  std::optional<std::pair<Added, std::size_t>> nearest;
  for (const std::size_t i : candidates) {
    const Added added = added_by(set, agreeing.chosen, agreeing.fit, i, tuning);
    if (added.probability > tuning.unremarkable) plain.push_back(i);
    if (!nearest || added.squares < nearest->first.squares) nearest = {added, i};
  }
  const double tail = heaviest_tail(set, agreeing.fit, options);
  if (nearest->first.probability < options.wrong_probability && nearest->first.squares > tail) return {};
  if (plain.empty()) plain.push_back(nearest->second);
  return plain;
}

/// Adds samples, best first, as long as noise explains them.
AgreeingSamples taken_in(const SampleSet& set, const Trimmed& trimmed, const SampleOptions& options,
                         const AgreeingOptions& tuning) {
  AgreeingSamples result{trimmed.chosen, trimmed.fit};
  FitSettings settings = settings_of(options);
  settings.precision = FitPrecision::on_the_way;
  while (result.chosen.size() < set.size()) {
    const Indices next = next_samples(set, result, options, tuning);
    if (next.empty()) break;
    Indices more;
    std::merge(result.chosen.begin(), result.chosen.end(), next.begin(), next.end(),
               std::back_inserter(more));
    result.chosen = std::move(more);
    settings.start = result.fit;
    result.fit = fit_samples(set, result.chosen, settings);
  }
  settings.start = result.fit;
  settings.precision = FitPrecision::exact;
  result.fit = fit_samples(set, result.chosen, settings);
  return result;
}

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

/// Is it sure that a search from triples of samples would find nothing better?
bool beyond_doubt(const SampleSet& set, const Trimmed& trimmed, const AgreeingSamples& agreeing,
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
  const Search search(set, options, tuning);
  if (set.size() >= tuning.least_for_congruence) {
    const Trimmed trimmed = search.from_all();
    AgreeingSamples agreeing = taken_in(set, trimmed, options, tuning);
    if (beyond_doubt(set, trimmed, agreeing, tuning)) return agreeing;
  }
  return taken_in(set, search.best(), options, tuning);
}

}  // namespace egocal::detail
