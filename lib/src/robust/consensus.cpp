// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/robust/consensus.hpp"

#include <algorithm>
#include <utility>

#include "robust/consensus_search.hpp"
#include "statistics/draws.hpp"

namespace egocal {

namespace {

using detail::ConsensusSearch;
using Candidate = ConsensusSearch::Candidate;

std::vector<double> only(std::size_t parts, std::size_t first, std::size_t last) {
  std::vector<double> factors(parts, 0.0);
  std::fill(factors.begin() + static_cast<std::ptrdiff_t>(first),
            factors.begin() + static_cast<std::ptrdiff_t>(last), 1.0);
  return factors;
}

/// Fits of each of `pieces` contiguous pieces.
void fit_pieces(const ConsensusSearch& search, std::size_t pieces, std::vector<Candidate>& fits) {
  const std::size_t n = search.size();
  for (std::size_t k = 0; k < pieces; ++k)
    fits.push_back(search.fit(only(n, k * n / pieces, (k + 1) * n / pieces)));
}

/// Fits of three sixteenths drawn together (a piece may be free of what is wrong and yet too short to show
/// every direction), and of four parts (what is wrong may be everywhere).
void fit_draws(const ConsensusSearch& search, const ConsensusOptions& options, std::vector<Candidate>& fits) {
  const std::size_t n = search.size();
  detail::Draws draws;
  for (std::size_t i = 0; i < options.draws_of_pieces; ++i) {
    std::vector<double> factors(n, 0.0);
    for (int piece = 0; piece < 3; ++piece) {
      const std::size_t k = draws.below(16);
      const std::vector<double> more = only(n, k * n / 16, (k + 1) * n / 16);
      for (std::size_t part = 0; part < n; ++part) factors[part] = std::max(factors[part], more[part]);
    }
    fits.push_back(search.fit(factors));
  }
  for (std::size_t i = 0; i < options.draws_of_parts; ++i) {
    std::vector<double> factors(n, 0.0);
    for (int part = 0; part < 4; ++part) factors[draws.below(n)] = 1;
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
  const ConsensusSearch search(problem, parts, overlap, options);
  if (!(search.motion() > 0)) return std::nullopt;

  std::vector<Candidate> starts;
  for (const std::size_t pieces : {1u, 2u, 4u}) fit_pieces(search, pieces, starts);
  // the tightest fit of half of the motion shows what is typical
  ResidualScale scale = search.scale_of(starts.front());
  const auto tighten = [&](const Candidate& fit) {
    if (search.is_no_tighter(fit, scale)) return;
    const ResidualScale here = search.scale_of(fit);
    if (product(here) < product(scale)) scale = here;
  };
  for (const Candidate& start : starts) tighten(start);
  // Usually nothing is wrong: if the fit of the whole is good, and no part is worse than noise explains, the
  // search is over. (Gross errors of many parts make the fit bad for all; those of few are outliers.)
  if (scale.relative < options.good_fit &&
      search.largest_excess(starts.front(), scale) < options.unsuspicious)
    return search.consensus(std::move(starts.front()), scale, std::vector<double>(parts.size(), 1.0));

  const std::size_t looked_at = starts.size();
  for (const std::size_t pieces : {8u, 16u}) fit_pieces(search, pieces, starts);
  fit_draws(search, options, starts);
  for (std::size_t i = looked_at; i < starts.size(); ++i) tighten(starts[i]);
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
    const double before = product(scale);
    tighten(best);
    if (product(scale) == before) break;  // another round would be the same
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

}  // namespace egocal
