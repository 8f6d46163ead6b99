// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "robust/consensus_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robust/excess.hpp"
#include "robust/residual_limit.hpp"
#include "solvers/minimiser.hpp"

namespace egocal::detail {

namespace {

double weighted_median(std::vector<std::pair<double, double>> values_weights) {
  std::sort(values_weights.begin(), values_weights.end());
  double total = 0, sum = 0;
  for (const auto& entry : values_weights) total += entry.second;
  for (const auto& [value, weight] : values_weights) {
    sum += weight;
    if (2 * sum >= total) return value;
  }
  return 0;
}

}  // namespace

ConsensusSearch::ConsensusSearch(const Problem& problem, std::span<const Statistics> statistics, int overlap,
                                 const ConsensusOptions& options)
    : options_(options), mode_(problem.mode), overlap_(overlap) {
  for (const Statistics& part : statistics) {
    const Matrix8d Q = cost_matrix(part, problem.balance);
    parts_.push_back({Q, part.weight, static_cast<double>(part.count), squared_size(Q),
                      excess_limit(part.count, options)});
  }
  // a wrong pose may make motions longer than all others together
  const double most = options.most_size * typical_size();
  for (Part& part : parts_) {
    part.motion = part.weight * std::min(part.size, most);
    all_ += part.motion;
  }
}

ConsensusSearch::Candidate ConsensusSearch::fit(const std::vector<double>& factors) const {
  Matrix8d Q = Matrix8d::Zero();
  double weight = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!(factors[i] > 0)) continue;
    Q += factors[i] * parts_[i].weight * parts_[i].Q;
    weight += factors[i] * parts_[i].weight;
  }
  if (weight > 0) Q /= weight;
  Candidate fit{minimiser(Q), {}};
  for (const Part& part : parts_) fit.residuals.push_back(std::max(0.0, cost(part.Q, fit.q)));
  return fit;
}

ResidualScale ConsensusSearch::scale_of(const Candidate& fit) const {
  std::vector<std::pair<double, double>> absolute, relative;
  double weight = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const double motion = parts_[i].motion;
    weight += parts_[i].weight;
    if (!(motion > 0)) continue;
    absolute.emplace_back(fit.residuals[i], motion);
    relative.emplace_back(fit.residuals[i] / parts_[i].size, motion);
  }
  const double least = options_.rounding * options_.rounding;
  return {std::max(weighted_median(std::move(absolute)), least * all_ / weight),
          std::max(weighted_median(std::move(relative)), least)};
}

bool ConsensusSearch::is_no_tighter(const Candidate& fit, const ResidualScale& than) const {
  double all = 0, below_absolute = 0, below_relative = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const double motion = parts_[i].motion;
    if (!(motion > 0)) continue;
    all += motion;
    if (fit.residuals[i] < than.absolute) below_absolute += motion;
    if (fit.residuals[i] / parts_[i].size < than.relative) below_relative += motion;
  }
  // the median is not among what is smaller, unless sums in another order are rounded over the half
  constexpr double slack = 1e-9;
  const double half = 0.5 * (1 - slack) * all;
  return below_absolute < half && below_relative < half;
}

double ConsensusSearch::excess_of(const Candidate& fit, std::size_t i, const ResidualScale& scale) const {
  return parts_[i].size > 0 ? excess(fit.residuals[i], parts_[i].size, scale, options_) : 0;
}

double ConsensusSearch::largest_excess(const Candidate& fit, const ResidualScale& scale) const {
  double largest = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) largest = std::max(largest, excess_of(fit, i, scale));
  return largest;
}

double ConsensusSearch::truncated_cost(const Candidate& fit, const ResidualScale& scale) const {
  double sum = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    sum += parts_[i].weight * std::min(1.0, excess_of(fit, i, scale) / parts_[i].limit);
  return sum;
}

std::vector<double> ConsensusSearch::agreeing(const Candidate& fit, const ResidualScale& scale) const {
  std::vector<double> factors;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    factors.push_back(excess_of(fit, i, scale) <= parts_[i].limit ? 1 : 0);
  return factors;
}

double ConsensusSearch::motion_of(const std::vector<double>& factors) const {
  double sum = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) sum += factors[i] * parts_[i].motion;
  return sum;
}

ConsensusSearch::Candidate ConsensusSearch::settled(Candidate fit, const ResidualScale& scale) const {
  std::vector<double> factors = agreeing(fit, scale);
  for (int i = 0; i < 10 && motion_of(factors) > 0; ++i) {
    fit = this->fit(factors);
    std::vector<double> next = agreeing(fit, scale);
    if (next == factors) break;
    factors = std::move(next);
  }
  return fit;
}

ConsensusSearch::Candidate ConsensusSearch::graduated(Candidate fit, const ResidualScale& scale) const {
  double largest = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    largest = std::max(largest, excess_of(fit, i, scale) / parts_[i].limit);
  for (double mu = 2 * largest; mu > 1; mu /= 2) {
    std::vector<double> factors;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const double w = mu / (excess_of(fit, i, scale) / parts_[i].limit + mu);
      factors.push_back(w * w);
    }
    fit = this->fit(factors);
  }
  return fit;
}

ConsensusSearch::Candidate ConsensusSearch::without_dissenters(Candidate fit,
                                                               std::vector<double>& factors) const {
  const std::vector<Alone> alone = fit_alone();
  while (const std::optional<std::size_t> i = dissenter(fit, alone, factors)) {
    const double rest = motion_of(factors) - parts_[*i].motion;
    if (rest < options_.majority * motion()) break;
    factors[*i] = 0;
    fit = this->fit(factors);
  }
  return fit;
}

Consensus ConsensusSearch::consensus(Candidate fit, const ResidualScale& scale,
                                     std::vector<double> factors) const {
  fit = without_dissenters(std::move(fit), factors);
  Consensus consensus{{fit.q, scale}, {}};
  for (const double factor : factors) consensus.outlier.push_back(factor == 0);
  return consensus;
}

double ConsensusSearch::typical_size() const {
  std::vector<std::pair<double, double>> sizes;
  for (const Part& part : parts_) sizes.emplace_back(part.size, part.weight * std::sqrt(part.size));
  return weighted_median(std::move(sizes));
}

DualQuaternion ConsensusSearch::minimiser(const Matrix8d& Q) const {
  return detail::minimiser(Q, mode_);
}

std::vector<ConsensusSearch::Alone> ConsensusSearch::fit_alone() const {
  std::vector<Alone> alone;
  std::vector<std::pair<double, double>> absolute, relative;
  for (const Part& part : parts_) {
    Alone& one = alone.emplace_back();
    if (!is_run(part)) continue;
    one.residual = std::max(0.0, cost(part.Q, minimiser(part.Q)));
    absolute.emplace_back(one.residual, part.weight);
    relative.emplace_back(one.residual / part.size, part.weight);
  }
  const double typical = weighted_median(std::move(absolute));
  const double least = options_.rounding * options_.rounding;
  const double typical_relative = std::max(weighted_median(std::move(relative)), least);
  for (std::size_t i = 0; i < parts_.size(); ++i)
    alone[i].noise = std::max(
        {alone[i].residual, std::min(typical, typical_relative * parts_[i].size), least * parts_[i].size});
  return alone;
}

std::optional<std::size_t> ConsensusSearch::dissenter(const Candidate& fit, const std::vector<Alone>& alone,
                                                      const std::vector<double>& factors) const {
  std::vector<std::pair<double, double>> gains;
  std::size_t most = 0;
  double most_found = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!(factors[i] > 0) || !is_run(parts_[i])) continue;
    const double gain = parts_[i].count * (fit.residuals[i] - alone[i].residual) / alone[i].noise;
    gains.emplace_back(gain, 1);
    if (gain > most_found) {
      most_found = gain;
      most = i;
    }
  }
  if (gains.size() < options_.least_parts) return std::nullopt;
  const double typical = std::max(weighted_median(std::move(gains)), options_.least_gain);
  return most_found > options_.most_gain * typical ? std::optional(most) : std::nullopt;
}

}  // namespace egocal::detail
