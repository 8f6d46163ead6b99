// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/offset/refinement.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "egocal/microseconds.hpp"
#include "egocal/motions/instant.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/statistics/median.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "pairing/offset/pose_at.hpp"
#include "pairing/offset/turning.hpp"

namespace egocal::detail {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t interpolation_cost = 4;  ///< of a motion's two poses, in poses looked at

/// Marks as outliers the motions that are `outlier` times farther off than is typical of their size. A wrong
/// offset moves large motions most, which must not make them outliers.
void mark_outliers(const std::vector<double>& sizes, const std::vector<double>& differences, double outlier,
                   double floor, const RefinementOptions& tuning, std::vector<char>& inlier) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < sizes.size(); ++k)
    if (inlier[k]) order.push_back(k);
  if (order.size() < tuning.least_motions) return;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return sizes[i] < sizes[j] || (sizes[i] == sizes[j] && i < j);
  });
  const std::size_t classes = tuning.size_classes;
  for (std::size_t c = 0; c < classes; ++c) {
    const std::size_t begin = c * order.size() / classes, end = (c + 1) * order.size() / classes;
    std::vector<double> values;
    for (std::size_t i = begin; i < end; ++i) values.push_back(differences[order[i]]);
    const double limit = outlier * (median(std::move(values)) + floor);
    for (std::size_t i = begin; i < end; ++i)
      if (differences[order[i]] > limit) inlier[order[i]] = 0;
  }
}

/// Root of the residual (18) of one motion pair.
double residual(const MotionPair& pair, const Balance& balance, const DualQuaternion& q) {
  const Vector8d d = (pair.a * q).vec() - (q * pair.b).vec();
  return std::sqrt(balance.rotation * d.head<4>().squaredNorm() +
                   balance.translation * d.tail<4>().squaredNorm());
}

}  // namespace

Refinement::Refinement(const Trajectory& a, const Trajectory& b, const TimeOffsetOptions& options,
                       std::int64_t max_gap_us, Schedule& schedule, std::function<void()> done,
                       const RefinementOptions& tuning)
    : a_(a),
      b_(b),
      options_(options),
      tuning_(tuning),
      max_gap_us_(static_cast<double>(max_gap_us)),
      schedule_(schedule),
      done_(std::move(done)) {
  const auto period_a = static_cast<double>(median_period_us(a_)),
             period_b = static_cast<double>(median_period_us(b_));
  keys_are_b_ = period_b >= options_.least_period_ratio * period_a;
  period_us_ = std::max(period_a, period_b);
}

void Refinement::begin(const ClockLine& model, double arm_us) {
  model_ = model;
  drifts_ = model.rate != 0;
  // far enough apart for the cost to rise above its noise
  least_arm_us_ = std::max(options_.least_arm * second_us, tuning_.least_arm * period_us_);
  arm_us_ = std::max(arm_us, least_arm_us_);
  schedule_.add(256, [this] {
    collect_motions();
    round();
  });
}

void Refinement::collect_motions() {
  const Trajectory& keys = keys_are_b_ ? b_ : a_;
  const double key_period_us = static_cast<double>(median_period_us(keys));
  const auto steps =
      static_cast<std::size_t>(std::max(1.0, std::round(options_.motion * second_us / key_period_us)));
  const double longest_us = 2 * static_cast<double>(steps) * key_period_us + max_gap_us_;
  const auto every = std::max<std::size_t>(
      static_cast<std::size_t>(std::max(1.0, std::round(options_.key_spacing * second_us / key_period_us))),
      (keys.size() + options_.most_keys - 1) / options_.most_keys);
  for (std::size_t to = steps; to < keys.size(); to += every) {
    const std::size_t from = to - steps;
    if (static_cast<double>(keys[to].time_us - keys[from].time_us) > longest_us) continue;
    Motion motion{from, to, motion_between(keys[from].pose, keys[to].pose), 0};
    motion.angle = screw_of(motion.motion).angle;
    motions_.push_back(motion);
  }
  if (!keys.empty()) duration_ = static_cast<double>(keys.back().time_us - keys.front().time_us) / second_us;
}

/// Compares at three offsets.
void Refinement::round() {
  for (std::size_t which = 0; which < 3; ++which) {
    others_[which].assign(motions_.size(), {});
    statistics_[which].assign(tuning_.blocks, {});
    schedule_.add_range(
        motions_.size(), [this, which](std::size_t begin, std::size_t end) { sample(which, begin, end); },
        interpolation_cost);
  }
  schedule_.add(motions_.size() / 4, [this] { find_outliers(); });
  schedule_.add_range(motions_.size(),
                      [this](std::size_t begin, std::size_t end) { accumulate(begin, end); });
  schedule_.add(64, [this] { conclude(); });
}

void Refinement::sample(std::size_t which, std::size_t begin, std::size_t end) {
  const Trajectory &keys = keys_are_b_ ? b_ : a_, &others = keys_are_b_ ? a_ : b_;
  const std::int64_t key_at = keys_are_b_ ? model_.at_b_us : model_.at_a_us,
                     other_at = keys_are_b_ ? model_.at_a_us : model_.at_b_us;
  const double shift = model_.shift_us + (static_cast<double>(which) - 1) * arm_us_;
  const auto on_other_clock = [&](std::size_t key) {
    const auto time = static_cast<double>(keys[key].time_us - key_at);
    return keys_are_b_ ? (1 + model_.rate) * time + shift : (time - shift) / (1 + model_.rate);
  };
  std::size_t near_from = first_before(others, other_at, on_other_clock(motions_[begin].from));
  std::size_t near_to = near_from;
  for (std::size_t k = begin; k < end; ++k) {
    const Motion& motion = motions_[k];
    const auto from = pose_at(others, other_at, on_other_clock(motion.from), max_gap_us_, near_from);
    const auto to = pose_at(others, other_at, on_other_clock(motion.to), max_gap_us_, near_to);
    if (!from || !to) continue;
    Other& other = others_[which][k];
    other.motion = motion_between(*from, *to);
    other.angle = screw_of(other.motion).angle;
    other.known = true;
  }
}

MotionPair Refinement::pair(std::size_t which, std::size_t k) const {
  const DualQuaternion &key = motions_[k].motion, &other = others_[which][k].motion;
  return keys_are_b_ ? MotionPair{other, key} : MotionPair{key, other};
}

/// First by the angles alone, which need no extrinsic; then also by the residuals.
void Refinement::find_outliers() {
  const std::size_t n = motions_.size();
  inlier_.assign(n, 0);
  std::vector<double> sizes(n), differences(n);
  const auto best_of_three = [&](auto difference) {
    for (std::size_t k = 0; k < n; ++k) {
      if (!inlier_[k]) continue;
      differences[k] = infinity;
      for (std::size_t which = 0; which < 3; ++which)
        differences[k] = std::min(differences[k], difference(which, k));
    }
  };
  for (std::size_t k = 0; k < n; ++k) {
    inlier_[k] = others_[0][k].known && others_[1][k].known && others_[2][k].known;
    sizes[k] = std::min(motions_[k].angle, others_[1][k].angle);
  }
  best_of_three([this](std::size_t which, std::size_t k) {
    return std::abs(motions_[k].angle - others_[which][k].angle);
  });
  mark_outliers(sizes, differences, options_.outlier, options_.angle_floor, tuning_, inlier_);
  if (!q_) return;
  const Balance balance{1, options_.translation_weight};
  best_of_three([&](std::size_t which, std::size_t k) { return residual(pair(which, k), balance, *q_); });
  mark_outliers(sizes, differences, options_.outlier, options_.angle_floor, tuning_, inlier_);
}

void Refinement::accumulate(std::size_t begin, std::size_t end) {
  if (begin == 0) times_.assign(tuning_.blocks, 0);
  const Trajectory& keys = keys_are_b_ ? b_ : a_;
  const std::int64_t key_at = keys_are_b_ ? model_.at_b_us : model_.at_a_us;
  for (std::size_t k = begin; k < end; ++k) {
    if (!inlier_[k]) continue;
    const std::size_t block = k * tuning_.blocks / motions_.size();
    for (std::size_t which = 0; which < 3; ++which) statistics_[which][block].add(pair(which, k));
    const std::int64_t middle = (keys[motions_[k].from].time_us + keys[motions_[k].to].time_us) / 2;
    times_[block] += static_cast<double>(middle - key_at) / second_us;
  }
}

/// Newton step in offset and rate (s, s/s) to the minimum of the cost, from how the costs of the parts of the
/// drive change with the offset. The extrinsic is eliminated by its Schur complement: at constant velocity
/// another offset looks like another lever arm. Standard deviations come from the scatter of the parts, as
/// neighbouring motions share poses and errors.
Refinement::NewtonStep Refinement::newton_step(double arm, const Balance& balance) const {
  using Matrix86 = Eigen::Matrix<double, 8, 6>;
  using Matrix62 = Eigen::Matrix<double, 6, 2>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  struct Part {
    double slope = 0, curvature = 0;
    Eigen::Vector2d row;      // derivative of the offset by offset and rate
    Vector6 gradient, cross;  // by the extrinsic, and its change with the offset
  };
  const Vector8d q = q_->vec();
  Matrix86 tangent;
  for (int k = 0; k < 6; ++k) {
    DualQuaternion unit{Eigen::Vector4d::Zero(), Eigen::Vector4d::Zero()};
    (k < 3 ? unit.real : unit.dual)[k % 3 + 1] = 1;
    tangent.col(k) = (*q_ * unit).vec();
  }
  const double weight = sum_blocks(statistics_[1]).weight;
  std::vector<Part> parts;
  Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  Matrix62 mixed = Matrix62::Zero();
  for (std::size_t i = 0; i < tuning_.blocks; ++i) {
    if (statistics_[1][i].count == 0) continue;
    const double share = statistics_[1][i].weight / weight;
    std::array<Matrix8d, 3> Q;
    for (std::size_t which = 0; which < 3; ++which)
      Q[which] = share * cost_matrix(statistics_[which][i], balance);
    Part part;
    const Matrix8d first = (Q[2] - Q[0]) / (2 * arm);
    part.slope = q.dot(first * q);
    part.curvature = q.dot((Q[0] - 2 * Q[1] + Q[2]) * q) / (arm * arm);
    part.row = {1, times_[i] / static_cast<double>(statistics_[1][i].count)};
    part.gradient = 2 * tangent.transpose() * (Q[1] * q);
    part.cross = 2 * tangent.transpose() * (first * q);
    H += part.curvature * part.row * part.row.transpose();
    g += part.slope * part.row;
    mixed += part.cross * part.row.transpose();
    parts.push_back(part);
  }
  const Matrix8d Q = cost_matrix(sum_blocks(statistics_[1]), balance);
  const SymmetricEigen<6> curvature = symmetric_eigen<6>(2 * tangent.transpose() * Q * tangent);
  // directions that the motions do not show change nothing
  Vector6 inverse = Vector6::Zero();
  for (int k = 0; k < 6; ++k)
    if (curvature.values[k] > 1e-9 * curvature.values[5]) inverse[k] = 1 / curvature.values[k];
  const Matrix62 follow = curvature.vectors * inverse.asDiagonal() * curvature.vectors.transpose() * mixed;
  H -= mixed.transpose() * follow;

  NewtonStep result;
  result.parts = parts.size();
  const auto count = static_cast<double>(parts.size());
  const auto scatter = [&](const Eigen::Vector2d& step) {
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    for (const Part& part : parts) {
      const double along = part.row.dot(step);
      const Eigen::Vector2d score = (part.slope + part.curvature * along) * part.row -
                                    follow.transpose() * (part.gradient + part.cross * along);
      sum += score * score.transpose();
    }
    return sum;
  };
  if (H(0, 0) > 0 && parts.size() >= 4) {
    const Eigen::Vector2d alone(-g(0) / H(0, 0), 0);
    result.stddev_without_rate = std::sqrt(count / (count - 1) * scatter(alone)(0, 0)) / H(0, 0);
  }
  result.with_rate = parts.size() >= 8 && H(1, 1) > 0 && H.determinant() > 1e-6 * H(0, 0) * H(1, 1);
  if (!result.with_rate) return result;
  const Eigen::Matrix2d back = H.inverse();
  result.step = -back * g;
  const Eigen::Matrix2d covariance = count / (count - 2) * back * scatter(result.step) * back;
  result.stddev = covariance.diagonal().cwiseSqrt();
  return result;
}

/// Moves to the minimum that three costs show, or ends the search.
void Refinement::conclude() {
  const Balance balance{1, options_.translation_weight};
  std::array<Solution, 3> solutions;
  const double weight = sum_blocks(statistics_[1]).weight;
  if (weight < 10) return done_();
  for (std::size_t which = 0; which < 3; ++which)
    solutions[which] = solve_dual(cost_matrix(sum_blocks(statistics_[which]), balance));
  const double low = solutions[0].cost, middle = solutions[1].cost, high = solutions[2].cost;
  q_ = solutions[1].q;
  const double arm = arm_us_ / second_us;
  const double slope = (high - low) / (2 * arm), curvature = (low - 2 * middle + high) / (arm * arm);

  const NewtonStep newton = newton_step(arm, balance);
  const bool bowl = curvature > 0;
  double step = bowl ? -slope / curvature : (low < high ? -arm : arm);
  double stddev = bowl && newton.parts >= 4 ? newton.stddev_without_rate : infinity;
  double rate_step = 0, rate_stddev = infinity;
  drifts_ = false;
  if (bowl && newton.with_rate) {
    rate_step = newton.step(1);
    rate_stddev = newton.stddev(1);
    const double rate = model_.rate + rate_step;
    drifts_ = duration_ >= options_.least_drift_duration && std::abs(rate) <= options_.most_drift &&
              std::abs(rate) > options_.drift_sigmas * rate_stddev &&
              std::abs(rate) * duration_ / 2 > options_.least_drift_effect;
    if (drifts_) {
      step = newton.step(0);
      stddev = newton.stddev(0);
    }
  }
  const bool inside = std::abs(step) <= arm;
  step = std::clamp(step, -2 * arm, 2 * arm);
  const double rate_before = model_.rate;
  const bool last = (arm_us_ <= least_arm_us_ && std::abs(step) < 0.5 * arm &&
                     std::abs(rate_step) * duration_ / 2 < 0.5 * arm) ||
                    ++round_ >= options_.most_rounds;
  const double measured_rate = rate_before + rate_step;
  model_.shift_us += step * second_us;
  model_.rate = drifts_ ? measured_rate : 0;
  if (last) return report(bowl && inside ? stddev : infinity, measured_rate, rate_stddev);
  if (inside) arm_us_ = std::max(arm_us_ / 2, least_arm_us_);
  round();
}

void Refinement::report(double stddev, double rate, double rate_stddev) {
  TimeOffset result;
  // whole microseconds first, as a date leaves no digits for fractions of them
  result.seconds = to_seconds(model_.at_a_us - model_.at_b_us) + 1e-6 * model_.shift_us;
  result.stddev = stddev;
  result.rate = rate;
  result.rate_stddev = rate_stddev;
  result.at_us = model_.at_b_us;
  result.drifts = drifts_;
  std::size_t known = 0, inliers = 0;
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    known += others_[0][k].known && others_[1][k].known && others_[2][k].known;
    if (!inlier_[k]) continue;
    ++inliers;
    const double x = motions_[k].angle, y = others_[1][k].angle;
    sa += x;
    sb += y;
    saa += x * x;
    sbb += y * y;
    sab += x * y;
  }
  const auto n = static_cast<double>(inliers);
  const double variance = (saa - sa * sa / n) * (sbb - sb * sb / n);
  result.correlation = variance > 0 ? (sab - sa * sb / n) / std::sqrt(variance) : 0;
  result.inliers = known > 0 ? n / static_cast<double>(known) : 0;
  result_ = result;
  done_();
}

}  // namespace egocal::detail
