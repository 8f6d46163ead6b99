// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/scale/estimate_scale.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "scale/kept_motions.hpp"

namespace egocal {

namespace {

/// SynchroniserOptions::slower_by with which the stamps are those of a, and of b, whatever their periods.
constexpr double least_slower_by = 0, most_slower_by = 1e9;

/// Motions of a fixed stride, none rejected: nothing is congruent at a wrong scale.
std::vector<MotionPair> first_pairs(const Trajectory& a, const Trajectory& b, PairingOptions pairing,
                                    double first_motion) {
  const Trajectory& slower = a.size() < b.size() ? a : b;
  if (slower.size() < 2) return {};
  const double span = 1e-6 * static_cast<double>(slower.back().time_us - slower.front().time_us);
  const double period = span / static_cast<double>(slower.size() - 1);
  pairing.stride = static_cast<int>(std::clamp(std::round(first_motion / std::max(period, 1e-6)), 1.0, 64.0));
  pairing.balance = Balance{};
  pairing.robust = false;
  return pair_motions(pairing, a, b).pairs;
}

double median_period(const Trajectory& trajectory) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    periods.push_back(1e-6 * static_cast<double>(trajectory[i].time_us - trajectory[i - 1].time_us));
  return detail::median(std::move(periods));
}

bool measured_together(const Trajectory& keys, const Trajectory& others) {
  std::size_t together = 0;
  for (std::size_t i = 0, j = 0; i < keys.size(); ++i) {
    while (j < others.size() && others[j].time_us < keys[i].time_us) ++j;
    together += j < others.size() && others[j].time_us == keys[i].time_us ? 1 : 0;
  }
  return 2 * together >= keys.size();
}

struct Stamps {  ///< whose are used, and typical times between two poses [s]
  Side keys = Side::b;
  double period = 0, other_period = 0;
};

Stamps stamps_of(const MotionPairing& drive, const Trajectory& a, const Trajectory& b) {
  const Side keys = drive.state().synchroniser.keys.value_or(Side::b);
  const double period_a = median_period(a), period_b = median_period(b);
  return keys == Side::a ? Stamps{keys, period_a, period_b} : Stamps{keys, period_b, period_a};
}

/// Motions with the stamps of the stream that `fixed` does not take them from, together with those given.
/// Interpolation shortens the motions of the stream that is interpolated by a part that grows with the square
/// of its period: weighted by these squares, both shorten alike.
std::vector<MotionPair> with_other_stamps(std::vector<MotionPair> pairs, const Trajectory& a,
                                          const Trajectory& b, PairingOptions fixed, const Stamps& stamps) {
  if (!(stamps.period > 0 && stamps.other_period > 0)) return pairs;
  fixed.synchroniser.slower_by = stamps.keys == Side::b ? least_slower_by : most_slower_by;
  fixed.stride = static_cast<int>(std::clamp(std::round(*fixed.stride * stamps.period / stamps.other_period),
                                             limits::stride.least, limits::stride.most));
  std::vector<MotionPair> others = pair_motions(fixed, a, b).pairs;
  if (others.empty()) return pairs;
  const double slow = stamps.period * stamps.period, fast = stamps.other_period * stamps.other_period;
  const double half = 0.5 * static_cast<double>(pairs.size() + others.size());
  for (MotionPair& pair : pairs)
    pair.eta *= 2 * slow / (slow + fast) * half / static_cast<double>(pairs.size());
  for (MotionPair& pair : others)
    pair.eta *= 2 * fast / (slow + fast) * half / static_cast<double>(others.size());
  pairs.insert(pairs.end(), others.begin(), others.end());
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const MotionPair& x, const MotionPair& y) { return x.end_us < y.end_us; });
  return pairs;
}

}  // namespace

ScaleSolution estimate_scale(std::span<const MotionPair> given, const DriveScaleOptions& options) {
  std::vector<MotionPair> kept = detail::of_plausible_length(given);
  ScaleSolution solution;
  for (int pass = 0; pass < 6; ++pass) {
    solution = solve_scale(scale_blocks(kept), options.scale);
    std::vector<double> residuals;
    for (const MotionPair& pair : given)
      residuals.push_back(detail::scale_residual(pair, solution, options.scale.side));
    const double limit = options.most_residual * detail::median(residuals);
    if (!(limit > 0) || !std::isfinite(limit)) break;
    std::vector<MotionPair> again;
    for (std::size_t i = 0; i < given.size(); ++i)
      if (residuals[i] <= limit) again.push_back(given[i]);
    const bool same = again.size() == kept.size();
    kept = std::move(again);
    if (same && pass > 0) break;
  }
  return solution;
}

ScaleSolution estimate_scale(const Trajectory& a, const Trajectory& b, const PairingOptions& given,
                             const DriveScaleOptions& given_options) {
  DriveScaleOptions options = given_options;
  const Side side = options.scale.side;
  PairingOptions pairing = given;
  pairing.track_time_offset = false;
  options.scale.mode = pairing.mode;
  // the height of the scaled sensor's plane is not to be scaled
  (side == Side::a ? pairing.plane_a : pairing.plane_b).distance = 0;

  const std::vector<MotionPair> first = first_pairs(a, b, pairing, options.first_motion);
  if (first.empty()) throw Error("scale: no motion pairs");
  options.scale.balance = detail::even_balance(scale_blocks(first), side);
  ScaleSolution solution = estimate_scale(first, options);
  double applied = solution.scale;
  const bool both_stamps =
      options.both_stamps && !(pairing.time_offset == 0 &&
                               measured_together(a.size() < b.size() ? a : b, a.size() < b.size() ? b : a));
  for (int round = 0; round < options.rounds; ++round) {
    const Trajectory scaled_a = side == Side::a ? scaled(a, applied) : a;
    const Trajectory scaled_b = side == Side::b ? scaled(b, applied) : b;
    PairingOptions fixed = pairing;
    if (!pairing.stride || !pairing.balance) {
      const Choice choice = pair_motions(pairing, scaled_a, scaled_b).drive.choice();
      fixed.stride = choice.stride;
      fixed.balance = choice.balance;
    }
    PairingResult paired = pair_motions(fixed, scaled_a, scaled_b);
    if (paired.pairs.size() < 2) break;
    DriveScaleOptions relative = options;
    relative.scale.balance = *fixed.balance;
    relative.scale.least = options.scale.least / applied;
    relative.scale.most = options.scale.most / applied;
    solution = estimate_scale(paired.pairs, relative);
    if (both_stamps) {
      const double one = solution.scale;
      solution = estimate_scale(with_other_stamps(std::move(paired.pairs), scaled_a, scaled_b, fixed,
                                                  stamps_of(paired.drive, a, b)),
                                relative);
      solution.stddev =
          std::hypot(solution.stddev, options.interpolation_doubt * std::abs(solution.scale - one));
    }
    const double factor = solution.scale;
    solution.scale *= applied;
    solution.least_scale *= applied;
    solution.most_scale *= applied;
    solution.stddev *= applied;
    if (!solution.observable) break;
    applied = solution.scale;
    if (std::abs(factor - 1) < 1e-3 * solution.stddev / solution.scale || std::abs(factor - 1) < 1e-9) break;
  }
  return solution;
}

}  // namespace egocal
