// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "egocal/uncertainty/observability.hpp"
#include "estimation/misfit.hpp"
#include "online/solve_and_verify.hpp"
#include "solvers/minimiser.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal {

namespace {

double score(const Spread& spread, int stride, const SelectionOptions& options) {
  double sum = 0;
  if (spread.rotation > 0) sum += std::log(std::max(spread.rotation, options.least_rotation));
  if (spread.translation > 0) sum += std::log(std::max(spread.translation, options.least_translation));
  const bool noise =
      spread.rotation > options.least_rotation || spread.translation > options.least_translation;
  return noise ? sum - options.longer * std::log2(stride) : sum;
}

/// A setting is not taken where its answer leaves this many times as much of the motions of its stride as the
/// answer of another balance (detail::misfit()), however small its spread is: it is a wrong minimum, or rests
/// on the noise of what counts too much. As WeightingOptions::less_likely, with the same study
/// (docs/weights.md, "Wrong minima").
constexpr double less_likely = 2;

/// A setting with its answer.
struct Trial {
  DualQuaternion T_a_b;
  Observability known;
  Spread spread;      ///< of no directions where none is seen
  double misfit = 0;  ///< of the answer, by the motions of the setting's stride
};

DualQuaternion minimiser_of(const DualQuaternion& T_a_b, const Problem& problem) {
  if (problem.mode == Mode::spatial) return T_a_b;
  return planar_from_extrinsic(T_a_b, plane_frame(problem.plane_a), plane_frame(problem.plane_b));
}

/// parts: with blocks of at least two strides. Empty: too few for a spread.
std::optional<Trial> tried(const Problem& parts, const SelectionOptions& options) {
  if (parts.blocks.size() < options.least_parts) return std::nullopt;
  const Matrix8d Q = cost_matrix(parts);
  Trial result;
  result.T_a_b = detail::solve_and_verify(parts, Q, Method::dual).T_a_b;
  result.misfit = detail::misfit(sum_blocks(parts.blocks), minimiser_of(result.T_a_b, parts),
                                 options.least_rotation, options.least_translation);
  result.known = assess_observability(parts, Q, result.T_a_b, ErrorCorrelation::independent);
  const Observability& known = result.known;
  double rotation = 0, translation = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!known.observable[i] || !std::isfinite(known.stddev[i])) continue;
    ++result.spread.directions;
    (i < 3 ? translation : rotation) += known.stddev[i] * known.stddev[i];
  }
  result.spread.rotation = std::sqrt(rotation);
  result.spread.translation = std::sqrt(translation);
  return result;
}

/// Whether longer motions contradict the answer in a direction that the shorter ones claim to know better.
bool contradicted(const Trial& shorter, const Trial& longer, const SelectionOptions& options) {
  const detail::Vector6d difference = detail::frame_a_difference(shorter.T_a_b, longer.T_a_b);
  for (std::size_t i = 0; i < 6; ++i) {
    if (!shorter.known.observable[i] || !longer.known.observable[i]) continue;
    const double stddev = longer.known.stddev[i];
    if (!(shorter.known.stddev[i] < stddev)) continue;
    if (std::abs(difference[static_cast<Eigen::Index>(i)]) > options.contradicts * stddev) return true;
  }
  return false;
}

std::uint64_t two_motions(int stride) {
  return 2 * static_cast<std::uint64_t>(stride);
}

/// Translation weights below `least` to try after `chosen` won (SelectionOptions::imbalance), in falling
/// order [1/m^2]; usually none.
std::vector<double> smaller_balances(const Problem& problem, const Candidate& chosen, double least,
                                     const SelectionOptions& options) {
  if (problem.mode == Mode::planar) return {};
  const Statistics sum = sum_blocks(chosen.blocks);
  const DualQuaternion q = detail::minimiser(cost_matrix(sum, chosen.balance), problem.mode);
  const double translation = q.vec().dot(sum.dual_rows * q.vec()),
               rotation = q.real.dot(sum.dual_rows.bottomRightCorner<4, 4>() * q.real);
  std::vector<double> balances;
  double balance = least;
  const bool errs = translation > options.least_error * options.least_error * sum.weight;
  if (!errs || !(balance * translation > options.imbalance * rotation)) return balances;
  while (balance > options.least_balance && options.imbalance * balance * translation > rotation) {
    balance /= 10;
    balances.push_back(balance);
  }
  return balances;
}

bool same(const Setting& x, const Setting& y) {
  return x.stride == y.stride && x.balance.rotation == y.balance.rotation &&
         x.balance.translation == y.balance.translation;
}

}  // namespace

std::vector<Statistics> merge_blocks(const std::vector<Statistics>& blocks, std::uint64_t least_pairs) {
  std::vector<Statistics> parts;
  parts.reserve(blocks.size());
  for (const Statistics& block : blocks) {
    if (parts.empty() || parts.back().count >= least_pairs) parts.emplace_back();
    parts.back() += block;
  }
  // a rest that is too short joins its neighbour
  if (parts.size() > 1 && parts.back().count < least_pairs) {
    const Statistics rest = parts.back();
    parts.pop_back();
    parts.back() += rest;
  }
  return parts;
}

std::vector<Statistics> independent_blocks(const std::vector<Statistics>& blocks, int stride,
                                           const SelectionOptions& options) {
  const auto steps = static_cast<std::uint64_t>(stride);
  std::vector<Statistics> long_ones = merge_blocks(blocks, 4 * steps);
  return long_ones.size() >= options.least_parts ? long_ones : merge_blocks(blocks, 2 * steps);
}

std::optional<Selection> select_candidate(const Problem& problem, std::span<const Candidate> candidates,
                                          std::optional<std::size_t> current,
                                          const SelectionOptions& options) {
  std::vector<std::optional<Trial>> trials;
  trials.reserve(candidates.size());
  Problem parts = problem;
  for (const Candidate& candidate : candidates) {
    parts.balance = candidate.balance;
    parts.blocks = merge_blocks(candidate.blocks, two_motions(candidate.stride));
    trials.push_back(tried(parts, options));
  }
  const auto score_of = [&](std::size_t i) {
    return score(trials[i]->spread, candidates[i].stride, options) -
           (current == i ? 2 * options.hysteresis : 0);
  };
  const auto refuted = [&](std::size_t i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < trials.size(); ++k)
      if (trials[k] && candidates[k].stride == candidates[i].stride)
        least = std::min(least, trials[k]->misfit);
    return trials[i]->misfit - least > std::log(less_likely);
  };
  const auto better = [&](std::size_t i, std::size_t than) {
    const int here = trials[i]->spread.directions, there = trials[than]->spread.directions;
    return here > there || (here == there && score_of(i) < score_of(than));
  };
  // from the longest motions to the shortest, each against the best balance of every longer stride
  std::vector<std::size_t> by_stride(candidates.size());
  std::iota(by_stride.begin(), by_stride.end(), std::size_t{0});
  std::stable_sort(by_stride.begin(), by_stride.end(),
                   [&](std::size_t x, std::size_t y) { return candidates[x].stride > candidates[y].stride; });
  std::vector<std::size_t> longer;  // the best of each
  std::vector<bool> possible(candidates.size(), false);
  for (auto next = by_stride.begin(); next != by_stride.end();) {
    const int stride = candidates[*next].stride;
    std::optional<std::size_t> best;
    for (; next != by_stride.end() && candidates[*next].stride == stride; ++next) {
      if (!trials[*next] || trials[*next]->spread.directions == 0 || refuted(*next)) continue;
      possible[*next] = std::none_of(longer.begin(), longer.end(), [&](std::size_t other) {
        return contradicted(*trials[*next], *trials[other], options);
      });
      if (!best || better(*next, *best)) best = *next;
    }
    if (best) longer.push_back(*best);
  }
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (possible[i] && (!best || better(i, *best))) best = i;
  return best ? std::optional(Selection{*best, trials[*best]->spread}) : std::nullopt;
}

std::optional<SelectedSetting> select_setting(const Problem& problem,
                                              std::span<const MotionsOfStride> strides,
                                              std::span<const double> balances,
                                              const std::optional<Balance>& fixed,
                                              const std::optional<Setting>& current,
                                              const SelectionOptions& options) {
  std::vector<Balance> tried;
  if (fixed) {
    tried.push_back(*fixed);
  } else {
    for (const double translation : balances) tried.push_back({1, translation});
  }
  std::vector<Candidate> candidates;
  const auto select = [&] {
    candidates.clear();
    candidates.reserve(strides.size() * tried.size());
    std::optional<std::size_t> in_force;
    for (const MotionsOfStride& of : strides) {
      for (const Balance& balance : tried) {
        if (current && same(*current, {of.stride, balance})) in_force = candidates.size();
        candidates.push_back({of.stride, balance, of.blocks});
      }
    }
    return select_candidate(problem, candidates, in_force, options);
  };
  std::optional<Selection> selection = select();
  if (selection && !fixed) {
    const double least = std::ranges::min(balances);
    const std::vector<double> smaller =
        smaller_balances(problem, candidates[selection->index], least, options);
    for (const double translation : smaller) tried.push_back({1, translation});
    if (!smaller.empty()) selection = select();
  }
  if (!selection) return std::nullopt;
  const Candidate& best = candidates[selection->index];
  return SelectedSetting{{best.stride, best.balance}, selection->spread, candidates.size()};
}

}  // namespace egocal
