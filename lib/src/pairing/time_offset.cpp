// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/time_offset.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/solvers/dual.hpp"

namespace egocal {

namespace {

double seconds(std::int64_t us) {
  return 1e-6 * static_cast<double>(us);
}

double median_period(const Trajectory& trajectory) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    periods.push_back(trajectory[i].time_us - trajectory[i - 1].time_us);
  std::nth_element(periods.begin(), periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2),
                   periods.end());
  return seconds(periods[periods.size() / 2]);
}

/// Pose at a time by screw interpolation; `from` is where to begin looking and moves on.
std::optional<DualQuaternion> pose_at(const Trajectory& trajectory, std::int64_t time_us,
                                      std::int64_t max_gap_us, std::size_t& from) {
  while (from + 1 < trajectory.size() && trajectory[from + 1].time_us <= time_us) ++from;
  if (from + 1 >= trajectory.size() || trajectory[from].time_us > time_us) return std::nullopt;
  const StampedPose &before = trajectory[from], &after = trajectory[from + 1];
  if (after.time_us - before.time_us > max_gap_us) return std::nullopt;
  return interpolate(
      before.pose, after.pose,
      static_cast<double>(time_us - before.time_us) / static_cast<double>(after.time_us - before.time_us));
}

/// Angles turned by in the window after each point of a grid [rad]; negative where not known.
struct Turning {
  std::int64_t begin_us = 0;
  std::vector<double> angles;
};

Turning turning(const Trajectory& trajectory, std::int64_t step_us, std::int64_t max_gap_us) {
  Turning result;
  result.begin_us = trajectory.front().time_us;
  std::size_t from = 0;
  std::vector<std::optional<DualQuaternion>> poses;
  for (std::int64_t t = result.begin_us; t <= trajectory.back().time_us; t += step_us)
    poses.push_back(pose_at(trajectory, t, max_gap_us, from));
  constexpr std::size_t window = 2;  // grid steps
  for (std::size_t i = 0; i + window < poses.size(); ++i)
    result.angles.push_back(
        poses[i] && poses[i + window] ? screw_of(conjugate(*poses[i]) * *poses[i + window]).angle : -1);
  return result;
}

struct Correlation {
  double value = 0;
  double significance = 0;  ///< in standard deviations of chance, taking every point as independent
};

/// Pearson's correlation where both are known, b shifted by `lag` grid points to the right.
Correlation correlation(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t lag,
                        std::size_t least_count) {
  const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, lag);
  const std::ptrdiff_t end =
      std::min(static_cast<std::ptrdiff_t>(a.size()), static_cast<std::ptrdiff_t>(b.size()) + lag);
  double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const double x = a[static_cast<std::size_t>(i)], y = b[static_cast<std::size_t>(i - lag)];
    if (x < 0 || y < 0) continue;
    n += 1;
    sa += x;
    sb += y;
    saa += x * x;
    sbb += y * y;
    sab += x * y;
  }
  if (n < static_cast<double>(least_count)) return {};
  const double variance = (saa - sa * sa / n) * (sbb - sb * sb / n);
  if (!(variance > 0)) return {};
  const double r = std::clamp((sab - sa * sb / n) / std::sqrt(variance), -0.9999999, 0.9999999);
  return {r, std::atanh(r) * std::sqrt(n - 3)};
}

/// The cost with b's stamps shifted by an offset.
struct OffsetCost {
  double cost = -1;  ///< its minimum; negative where nothing can be paired
  DualQuaternion q;  ///< minimiser
  Problem problem;
};

/// Motions of about half a second.
OffsetCost cost_at(const Trajectory& a, const Trajectory& b, double offset, int stride, double max_gap) {
  PairingOptions options;
  options.stride = stride;
  // rotations tell time; translations only with the lever arm
  options.balance = Balance{1, 0.01};
  options.time_offset = offset;
  options.max_gap = max_gap;
  options.robust = false;
  OffsetCost result;
  result.problem = pair_motions(options, a, b).drive.problem();
  if (total(result.problem.blocks).count < 10) return result;
  const Solution solution = solve_dual(cost_matrix(result.problem));
  result.cost = solution.cost;
  result.q = solution.q;
  return result;
}

/// Standard deviation of the slope of the cost between two offsets, at one extrinsic, from its spread over
/// consecutive parts of the drive: neighbouring motions share poses and errors. Not finite where there are
/// too few.
double slope_deviation(const OffsetCost& low, const OffsetCost& high, const DualQuaternion& q,
                       double distance) {
  const auto &x = low.problem.blocks, &y = high.problem.blocks;
  const std::size_t n = std::min(x.size(), y.size());
  if (n < 4) return INFINITY;
  const double weight = total(low.problem.blocks).weight;
  std::vector<double> slopes;
  double mean = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Balance& balance = low.problem.balance;
    const double share = x[i].weight / weight;
    slopes.push_back(share * (cost(cost_matrix(y[i], balance), q) - cost(cost_matrix(x[i], balance), q)) /
                     distance);
    mean += slopes.back() / static_cast<double>(n);
  }
  double squares = 0;
  for (const double slope : slopes) squares += (slope - mean) * (slope - mean);
  return std::sqrt(squares * static_cast<double>(n) / static_cast<double>(n - 1));
}

}  // namespace

std::optional<TimeOffset> estimate_time_offset(const Trajectory& a, const Trajectory& b,
                                               const TimeOffsetOptions& options) {
  if (a.size() < 10 || b.size() < 10) return std::nullopt;
  const double period = std::max(median_period(a), median_period(b));
  const double step = std::clamp(period, 0.05, 0.25);
  const auto step_us = static_cast<std::int64_t>(step * 1e6);
  const double max_gap = std::max(options.max_gap, 3 * period);
  const auto max_gap_us = static_cast<std::int64_t>(max_gap * 1e6);
  const Turning turning_a = turning(a, step_us, max_gap_us), turning_b = turning(b, step_us, max_gap_us);
  const auto least_count = static_cast<std::size_t>(options.least_overlap / step);

  Correlation best;
  std::ptrdiff_t best_lag = 0;
  const auto size_a = static_cast<std::ptrdiff_t>(turning_a.angles.size());
  const auto size_b = static_cast<std::ptrdiff_t>(turning_b.angles.size());
  for (std::ptrdiff_t lag = -size_b; lag <= size_a; ++lag) {
    const Correlation here = correlation(turning_a.angles, turning_b.angles, lag, least_count);
    if (here.significance > best.significance) {
      best = here;
      best_lag = lag;
    }
  }
  if (!(best.significance > 0)) return std::nullopt;
  const double coarse =
      seconds(turning_a.begin_us - turning_b.begin_us) + static_cast<double>(best_lag) * step;

  // The cost is a parabola near its minimum: a grid of half steps around the peak, then ever finer around the
  // best.
  const int stride = std::max(1, static_cast<int>(std::lround(0.5 / period)));
  double centre = coarse, width = step;
  OffsetCost low, middle, high;
  for (int round = 0; round < 10; ++round) {
    constexpr int points = 2;  // on each side
    double best_cost = -1, best_offset = centre;
    for (int i = -points; i <= points; ++i) {
      const double offset = centre + width * i / points;
      const OffsetCost here = cost_at(a, b, offset, stride, max_gap);
      if (here.cost < 0) continue;
      if (best_cost < 0 || here.cost < best_cost) {
        best_cost = here.cost;
        best_offset = offset;
      }
    }
    if (best_cost < 0) return std::nullopt;
    const bool at_the_edge = std::abs(best_offset - centre) > 0.9 * width;
    centre = best_offset;
    if (!at_the_edge) width /= 2;
    if (width < 0.004) break;
  }
  // vertex of the parabola through three points far enough apart to rise above the noise
  const double arm = std::max(0.02, 0.5 * period);
  low = cost_at(a, b, centre - arm, stride, max_gap);
  middle = cost_at(a, b, centre, stride, max_gap);
  high = cost_at(a, b, centre + arm, stride, max_gap);
  TimeOffset result{centre, width, best.value};
  const double curvature = (low.cost - 2 * middle.cost + high.cost) / (arm * arm);
  if (low.cost > 0 && high.cost > 0 && curvature > 0) {
    const double vertex = 0.5 * (low.cost - high.cost) / (curvature * arm);
    if (std::abs(vertex) < arm) result.seconds = centre + vertex;
    // the minimum moves by what the slope is wrong by
    result.stddev = slope_deviation(low, high, middle.q, 2 * arm) / curvature;
  }
  return result;
}

}  // namespace egocal
