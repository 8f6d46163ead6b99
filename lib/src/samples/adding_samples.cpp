// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/adding_samples.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "egocal/statistics/median.hpp"
#include "statistics/distributions.hpp"

namespace egocal::detail {

namespace {

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

/// Factor by which the variance by the median of all samples exceeds that of the chosen ones, which fit best.
double underestimated(const SampleSet& set, const SampleFit& fit) {
  constexpr double median_of_six = 5.348;  // mathematics: chi-squared, rotation and position
  std::vector<double> squares;
  for (std::size_t i = 0; i < set.size(); ++i) {
    squares.push_back(in_variances(set, i, fit));
  }
  const double middle = order_statistic_in_place(squares, (squares.size() - 1) / 2);
  return std::max(1.0, middle / median_of_six);
}

/// Whether noise explains a sample by its residual alone; a fit that includes the sample is at most this bad.
class PlainTest {
 public:
  PlainTest(const SampleSet& set, const SampleFit& fit, const AgreeingOptions& tuning)
      : set_(set), fit_(fit), unremarkable_(tuning.unremarkable) {}

  bool agrees(std::size_t one) {
    constexpr double dof = 6;  // mathematics: of a pose
    if (!(fit_.dof > 0) || !(fit_.cost > 0)) return false;
    const double f = in_variances(set_, one, fit_) / dof / fit_.variance;
    // the probability falls with f, so most samples are decided by earlier results
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

/// Residual above which a sample is wrong whatever its probability, in variances of the noise.
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

/// Samples to add next, in order: those that noise explains, else the nearest one; empty: that one is wrong.
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

}  // namespace

AgreeingSamples with_added_samples(const SampleSet& set, const TrimmedFit& trimmed,
                                   const SampleOptions& options, const AgreeingOptions& tuning) {
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

}  // namespace egocal::detail
