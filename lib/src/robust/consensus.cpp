// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/robust/consensus.hpp"

#include <algorithm>
#include <cmath>

#include "problem/motion_square.hpp"
#include "robust/residual_limit.hpp"
#include "solvers/minimiser.hpp"

namespace egocal {

namespace {

/// Mean squared size of the motions of a part in the metric of the cost (16): the cost of a wrong extrinsic
/// of this scale.
double squared_size(const Matrix8d& Q) {
  return Q.topLeftCorner<4, 4>().trace();
}

struct Part {
  Matrix8d Q;     ///< (16) of this part alone
  double weight;  ///< of its motions
  double count;
  double size;        ///< squared_size
  double limit;       ///< of the excess over typical
  double motion = 0;  ///< its share in what must agree [weight times squared size]
};

struct Candidate {
  DualQuaternion q;
  std::vector<double> residuals;  ///< mean squared, per part
};

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

double excess(double residual, double size, const ResidualScale& scale, const ConsensusOptions& options) {
  return std::min(residual / scale.absolute,
                  residual / (size * std::max(scale.relative, options.least_relative)));
}

class Search {
 public:
  Search(const Problem& problem, std::span<const Statistics> statistics, int overlap,
         const ConsensusOptions& options)
      : options_(options), mode_(problem.mode), overlap_(overlap) {
    for (const Statistics& part : statistics) {
      const Matrix8d Q = cost_matrix(part, problem.balance);
      parts_.push_back({Q, part.weight, static_cast<double>(part.count), squared_size(Q),
                        detail::excess_limit(part.count, options)});
    }
    // a wrong pose may make motions longer than all others together
    const double most = options.most_size * typical_size();
    for (Part& part : parts_) {
      part.motion = part.weight * std::min(part.size, most);
      all_ += part.motion;
    }
  }

  /// The motion of all parts [weight times squared size, which is limited for a part].
  double motion() const { return all_; }

  Candidate fit(const std::vector<double>& factors) const {
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

  /// Medians over the motion, not over time: a vehicle may be at rest for most of it.
  ResidualScale scale_of(const Candidate& fit) const {
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

  double excess_of(const Candidate& fit, std::size_t i, const ResidualScale& scale) const {
    return parts_[i].size > 0 ? excess(fit.residuals[i], parts_[i].size, scale, options_) : 0;
  }

  double largest_excess(const Candidate& fit, const ResidualScale& scale) const {
    double largest = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) largest = std::max(largest, excess_of(fit, i, scale));
    return largest;
  }

  double truncated_cost(const Candidate& fit, const ResidualScale& scale) const {
    double sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      sum += parts_[i].weight * std::min(1.0, excess_of(fit, i, scale) / parts_[i].limit);
    return sum;
  }

  std::vector<double> agreeing(const Candidate& fit, const ResidualScale& scale) const {
    std::vector<double> factors;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      factors.push_back(excess_of(fit, i, scale) <= parts_[i].limit ? 1 : 0);
    return factors;
  }

  double motion_of(const std::vector<double>& factors) const {
    double sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) sum += factors[i] * parts_[i].motion;
    return sum;
  }

  /// Solve over what agrees, until the same agree again.
  Candidate settled(Candidate fit, const ResidualScale& scale) const {
    std::vector<double> factors = agreeing(fit, scale);
    for (int i = 0; i < 10 && motion_of(factors) > 0; ++i) {
      fit = this->fit(factors);
      std::vector<double> next = agreeing(fit, scale);
      if (next == factors) break;
      factors = std::move(next);
    }
    return fit;
  }

  /// Graduated non-convexity (Yang et al. 2020) for the Geman-McClure loss: from the convex problem, all
  /// parts counting, to the sharp one.
  Candidate graduated(Candidate fit, const ResidualScale& scale) const {
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

  /// Drops the run that would gain most by an extrinsic of its own, again and again, as long as its gain is
  /// far above the others and a majority stays.
  Candidate without_dissenters(Candidate fit, std::vector<double>& factors) const {
    const std::vector<Alone> alone = fit_alone();
    while (const std::optional<std::size_t> i = dissenter(fit, alone, factors)) {
      const double rest = motion_of(factors) - parts_[*i].motion;
      if (rest < options_.majority * motion()) break;
      factors[*i] = 0;
      fit = this->fit(factors);
    }
    return fit;
  }

  Consensus consensus(Candidate fit, const ResidualScale& scale, std::vector<double> factors) const {
    fit = without_dissenters(std::move(fit), factors);
    Consensus consensus{{fit.q, scale}, {}};
    for (const double factor : factors) consensus.outlier.push_back(factor == 0);
    return consensus;
  }

  std::size_t size() const { return parts_.size(); }

 private:
  /// The squared size at or below which half of the way is made. Lengths and not squares, most of which
  /// belong to few wrong motions.
  double typical_size() const {
    std::vector<std::pair<double, double>> sizes;
    for (const Part& part : parts_) sizes.emplace_back(part.size, part.weight * std::sqrt(part.size));
    return weighted_median(std::move(sizes));
  }

  DualQuaternion minimiser(const Matrix8d& Q) const { return detail::minimiser(Q, mode_); }

  /// A run of motions with the extrinsic that suits it best.
  struct Alone {
    double residual = 0;  ///< mean squared
    double noise = 0;     ///< at least what is typical: a short run may fit by chance
  };

  bool is_run(const Part& part) const { return part.count >= options_.least_run * overlap_ && part.size > 0; }

  std::vector<Alone> fit_alone() const {
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

  /// The run that stands out among those that count. The gain is about that of six parameters fitted to
  /// noise: six times the noise of one motion, more if motions overlap.
  std::optional<std::size_t> dissenter(const Candidate& fit, const std::vector<Alone>& alone,
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

  const ConsensusOptions& options_;
  Mode mode_;
  int overlap_;
  std::vector<Part> parts_;
  double all_ = 0;
};

std::vector<double> only(std::size_t parts, std::size_t first, std::size_t last) {
  std::vector<double> factors(parts, 0.0);
  std::fill(factors.begin() + static_cast<std::ptrdiff_t>(first),
            factors.begin() + static_cast<std::ptrdiff_t>(last), 1.0);
  return factors;
}

/// Fits of each of `pieces` contiguous pieces.
void fit_pieces(const Search& search, std::size_t pieces, std::vector<Candidate>& fits) {
  const std::size_t n = search.size();
  for (std::size_t k = 0; k < pieces; ++k)
    fits.push_back(search.fit(only(n, k * n / pieces, (k + 1) * n / pieces)));
}

/// Fits of three sixteenths drawn together (a piece may be free of what is wrong and yet too short to show
/// every direction), and of four parts (what is wrong may be everywhere).
void fit_draws(const Search& search, const ConsensusOptions& options, std::vector<Candidate>& fits) {
  const std::size_t n = search.size();
  std::uint64_t drawn = 1;
  const auto draw = [&](std::size_t below) {
    drawn = 6364136223846793005u * drawn + 1442695040888963407u;  // Knuth's: the same draws every time
    return static_cast<std::size_t>((drawn >> 33) % below);
  };
  for (std::size_t i = 0; i < options.draws_of_pieces; ++i) {
    std::vector<double> factors(n, 0.0);
    for (int piece = 0; piece < 3; ++piece) {
      const std::size_t k = draw(16);
      const std::vector<double> more = only(n, k * n / 16, (k + 1) * n / 16);
      for (std::size_t part = 0; part < n; ++part) factors[part] = std::max(factors[part], more[part]);
    }
    fits.push_back(search.fit(factors));
  }
  for (std::size_t i = 0; i < options.draws_of_parts; ++i) {
    std::vector<double> factors(n, 0.0);
    for (int part = 0; part < 4; ++part) factors[draw(n)] = 1;
    fits.push_back(search.fit(factors));
  }
}

double product(const ResidualScale& scale) {
  return scale.absolute * scale.relative;
}

}  // namespace

std::optional<Consensus> find_consensus(const Problem& problem, std::span<const Statistics> parts,
                                        int overlap, const ConsensusOptions& options) {
  if (parts.size() < options.least_parts) return std::nullopt;
  const Search search(problem, parts, overlap, options);
  if (!(search.motion() > 0)) return std::nullopt;

  std::vector<Candidate> starts;
  for (const std::size_t pieces : {1u, 2u, 4u}) fit_pieces(search, pieces, starts);
  // the tightest fit of half of the motion shows what is typical
  ResidualScale scale = search.scale_of(starts.front());
  const auto tighten = [&](const Candidate& fit) {
    const ResidualScale here = search.scale_of(fit);
    if (product(here) < product(scale)) scale = here;
  };
  for (const Candidate& start : starts) tighten(start);
  // Usually nothing is wrong: if the fit of the whole is good, and no part is worse than noise explains, the
  // search is over. (Gross errors of many parts make the fit bad for all; those of few are outliers.)
  if (scale.relative < options.good_fit &&
      search.largest_excess(starts.front(), scale) < options.unsuspicious)
    return search.consensus(std::move(starts.front()), scale, std::vector<double>(parts.size(), 1.0));

  for (const std::size_t pieces : {8u, 16u}) fit_pieces(search, pieces, starts);
  fit_draws(search, options, starts);
  for (const Candidate& start : starts) tighten(start);
  starts.push_back(search.graduated(starts.front(), scale));
  tighten(starts.back());

  Candidate best = starts.front();
  for (int round = 0; round < 2; ++round) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < starts.size(); ++i)
      order.emplace_back(search.truncated_cost(starts[i], scale), i);
    std::sort(order.begin(), order.end());
    double least = search.truncated_cost(best, scale);
    for (std::size_t i = 0; i < std::min(order.size(), options.most_settled); ++i) {
      Candidate here = search.settled(starts[order[i].second], scale);
      const double cost = search.truncated_cost(here, scale);
      if (cost < least) {
        least = cost;
        best = std::move(here);
      }
    }
    tighten(best);
  }
  // the tightest fit may be tight by chance, with less than a majority
  best = search.settled(std::move(best), scale);
  std::vector<double> factors = search.agreeing(best, scale);
  const double majority = options.majority * search.motion();
  for (int i = 0; i < options.most_relaxed && search.motion_of(factors) < majority; ++i) {
    scale.absolute *= 2;
    scale.relative *= 2;
    best = search.settled(std::move(best), scale);
    factors = search.agreeing(best, scale);
  }
  if (search.motion_of(factors) < majority) return std::nullopt;
  return search.consensus(std::move(best), scale, std::move(factors));
}

double detail::excess_limit(std::uint64_t motions, const ConsensusOptions& options) {
  return options.limit_of_many +
         (options.limit_of_one - options.limit_of_many) / static_cast<double>(motions);
}

double detail::residual_limit(const Statistics& part, const Balance& balance, const ResidualScale& scale,
                              const ConsensusOptions& options) {
  const double size = squared_size(cost_matrix(part, balance));
  return detail::excess_limit(part.count, options) *
         std::max(scale.absolute, size * std::max(scale.relative, options.least_relative));
}

double detail::disagreement(const DualQuaternion& a, const DualQuaternion& b, const Balance& balance,
                            const Agreement& agreement, const ConsensusOptions& options) {
  const double sign_a = positive_sign(a), sign_b = positive_sign(b);
  const QuaternionDifference real(a.real, sign_a, b.real, sign_b), dual(a.dual, sign_a, b.dual, sign_b);
  const double rotation = real.squared_size();
  const double size = balance.translation * dual.squared_size() + balance.rotation * rotation;
  if (!(size > 0)) return 0;
  const DualQuaternion& q = agreement.q;
  // summed in the order of disagreements()
  const auto squared_norm = [](const QuaternionVector& x) {
    return (x[0] * x[0] + x[2] * x[2]) + (x[1] * x[1] + x[3] * x[3]);
  };
  const double residual = balance.translation * squared_norm(dual.times(q.real) + real.times(q.dual)) +
                          balance.rotation * squared_norm(real.times(q.real));
  return excess(residual, size, agreement.scale, options) / excess_limit(1, options);
}

double disagreement(const Statistics& part, const Balance& balance, const Agreement& agreement,
                    const ConsensusOptions& options) {
  const Matrix8d Q = cost_matrix(part, balance);
  const double size = squared_size(Q);
  if (!(size > 0)) return 0;
  return excess(std::max(0.0, cost(Q, agreement.q)), size, agreement.scale, options) /
         detail::excess_limit(part.count, options);
}

}  // namespace egocal
