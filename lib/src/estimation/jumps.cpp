// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/estimation/jumps.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "solvers/minimiser.hpp"
#include "statistics/select.hpp"

namespace egocal {

namespace {

std::size_t place(std::size_t count, double part) {
  return static_cast<std::size_t>(part * static_cast<double>(count - 1));
}

/// Numbers that are not set yet.
class Room {
 public:
  explicit Room(std::size_t size) : numbers_(std::make_unique_for_overwrite<double[]>(size)), size_(size) {}
  std::span<double> numbers() const { return {numbers_.get(), size_}; }

 private:
  std::unique_ptr<double[]> numbers_;
  std::size_t size_;
};

double quantile(std::span<const double> values, double part) {
  const Room room(2 * values.size());
  return detail::selected(values, place(values.size(), part), room.numbers());
}

struct Quartiles {
  double low = 0, median = 0, high = 0;

  explicit Quartiles(std::span<const double> values) {
    const std::size_t count = values.size(), first = place(count, 0.25), third = place(count, 0.75);
    const Room halves(2 * count), room_to_select(2 * count);
    const std::span<double> room = room_to_select.numbers();
    median = detail::selected(values, place(count, 0.5), room);
    double *const below = halves.numbers().data(), *const above = below + count;
    std::size_t smaller = 0, larger = 0;
    for (const double value : values) {  // without a branch that the processor could guess wrongly
      below[smaller] = above[larger] = value;
      smaller += static_cast<unsigned>(value < median);
      larger += static_cast<unsigned>(value > median);
    }
    low = first < smaller ? detail::selected({below, smaller}, first, room) : median;
    const std::size_t until_median = count - larger;
    high = third < until_median ? median : detail::selected({above, larger}, third - until_median, room);
  }
};

/// The angle by which both sensors turn at least [rad].
double smaller_angle(const Step& step) {
  const double sine_a = step.a.real.tail<3>().norm(), sine_b = step.b.real.tail<3>().norm();
  const DualQuaternion& smaller = sine_a < sine_b ? step.a : step.b;
  // below half a turn the sine of half an angle grows with the angle
  if (step.a.real[0] > 0.5 && step.b.real[0] > 0.5)
    return 2 * std::atan2(std::min(sine_a, sine_b), smaller.real[0]);
  return std::min(screw_of(step.a).angle, screw_of(step.b).angle);
}

/// One component (rotation or translation) of all steps.
struct Component {
  std::vector<double> size;      ///< the smaller of the two sensors', for a jump makes one of them large
  std::vector<double> residual;  ///< at the extrinsic under consideration
  double limit = 0, limit_relative = 0, cap = 0, typical = 0;

  double relative(std::size_t i) const { return residual[i] / (std::min(size[i], cap) + 1e-9); }

  void learn(const std::vector<double>& weights, double floor, const JumpOptions& options) {
    std::vector<double> sizes, absolute, part;
    for (std::vector<double>* values : {&sizes, &absolute, &part}) values->reserve(size.size());
    for (std::size_t i = 0; i < size.size(); ++i)
      if (weights[i] > options.least_weight) sizes.push_back(size[i]);
    if (sizes.size() < options.least_steps) return;
    cap = quantile(sizes, 0.9);
    for (std::size_t i = 0; i < size.size(); ++i) {
      if (!(weights[i] > options.least_weight)) continue;
      absolute.push_back(residual[i]);
      part.push_back(relative(i));
    }
    const Quartiles of_residuals(absolute), of_parts(part);
    typical = std::max(of_residuals.median, floor);
    limit = typical * factor(of_residuals, options);
    limit_relative = of_parts.median * factor(of_parts, options);
  }

  /// Squared ratio of a step's residual to the limit: above one the step is a jump.
  double excess(std::size_t i) const {
    if (!(limit > 0)) return 0;
    const double x = limit_relative > 0 ? std::min(residual[i] / limit, relative(i) / limit_relative)
                                        : residual[i] / limit;
    return x * x;
  }

  /// The residual as a multiple of the typical one.
  double multiple(std::size_t i) const { return typical > 0 ? residual[i] / typical : 0; }

 private:
  static double factor(const Quartiles& of, const JumpOptions& options) {
    const double ratio = of.low > 0 ? std::sqrt(of.high / of.low) : options.most_ratio;
    return std::pow(std::clamp(ratio, options.least_ratio, options.most_ratio), options.tail);
  }
};

class Judge {
 public:
  Judge(std::span<const MeasuredStep> steps, const JumpOptions& options) : steps_(steps), options_(options) {
    rotation_.size.reserve(steps.size());
    translation_.size.reserve(steps.size());
    weights.reserve(steps.size());
    for (const MeasuredStep& step : steps) {
      rotation_.size.push_back(step.angle);
      translation_.size.push_back(step.length);
      weights.push_back(step.step.usable ? 1 : 0);
    }
    rotation_.residual.resize(steps.size());
    translation_.residual.resize(steps.size());
  }

  /// Residuals at q, and what is typical of them.
  void look_from(const DualQuaternion& q) {
    const Pose T = to_pose(q);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (!usable(i)) continue;
      const Pose left = steps_[i].a * T, right = T * steps_[i].b;
      rotation_.residual[i] = 2 * (left.rotation * right.rotation.conjugate()).vec().norm();
      translation_.residual[i] = (left.translation - right.translation).norm();
    }
    rotation_.learn(weights, options_.rotation_floor, options_);
    translation_.learn(weights, options_.translation_floor, options_);
  }

  double excess(std::size_t i) const {
    return usable(i) ? std::max(rotation_.excess(i), translation_.excess(i)) : 0;
  }
  double largest_excess() const {
    double largest = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i) largest = std::max(largest, excess(i));
    return largest;
  }

  /// Sets Geman-McClure weights. False: the steps that count in what is typical have not changed.
  bool weigh(double mu) {
    bool other = false;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (!usable(i)) continue;
      const double w = mu / (excess(i) + mu);
      const bool counted = weights[i] > options_.least_weight;
      weights[i] = w * w;
      other = other || (weights[i] > options_.least_weight) != counted;
    }
    return other;
  }

  /// Weight of rotations, by the typical residuals. The dual rows contain half of a translation.
  double rotation_weight() const {
    if (!(rotation_.typical > 0) || !(translation_.typical > 0)) return 1;
    const double ratio = translation_.typical / rotation_.typical;
    return 0.25 * ratio * ratio;
  }

  std::vector<Jump> jumps() const {
    std::vector<Jump> result(steps_.size(), Jump::none);
    std::size_t jumps = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (!usable(i) || excess(i) <= 1) continue;
      result[i] = rotation_.excess(i) > 1 ? Jump::all : Jump::translation;
      ++jumps;
    }
    if (static_cast<double>(jumps) > options_.most_jumps * static_cast<double>(steps_.size()))
      result.assign(steps_.size(), Jump::none);
    return result;
  }

  /// Verdict on each step by the newest look.
  std::vector<StepVerdict> verdicts(const std::vector<Jump>& jumps) const {
    std::vector<StepVerdict> result;
    double far = 0, usable_steps = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      result.push_back({jumps[i], extra_variance(i, jumps[i])});
      if (usable(i)) ++usable_steps;
      if (result.back().extra_variance > 0) ++far;
    }
    if (far < std::max(options_.least_far, options_.heavy_tail * usable_steps))
      for (StepVerdict& verdict : result) verdict.extra_variance = 0;
    return result;
  }

  std::vector<double> weights;  ///< per step

 private:
  bool usable(std::size_t i) const { return steps_[i].step.usable; }

  /// No motion spans a jump; rotations that span a translation's jump count by rotation alone.
  double extra_variance(std::size_t i, Jump jump) const {
    if (!usable(i) || jump == Jump::all) return 0;
    double x = rotation_.multiple(i);
    if (jump == Jump::none) x = std::max(x, translation_.multiple(i));
    x /= options_.doubtful;
    return x > 1 ? x * x * x * x - 1 : 0;
  }

  std::span<const MeasuredStep> steps_;
  const JumpOptions& options_;
  Component rotation_, translation_;
};

/// Verdicts by a given extrinsic. The typical residuals are estimated again without the jumps found.
std::vector<StepVerdict> settle(Judge& judge, const DualQuaternion& q, int most_rounds) {
  std::vector<Jump> jumps;
  for (int round = 0; round < most_rounds; ++round) {
    judge.look_from(q);
    std::vector<Jump> next = judge.jumps();
    if (next == jumps) break;
    jumps = std::move(next);
    if (!judge.weigh(1)) break;  // another look would see the same
  }
  return judge.verdicts(jumps);
}

}  // namespace

MeasuredStep::MeasuredStep(const Step& given)
    : step(given), a(to_pose(given.a)), b(to_pose(given.b)), angle(smaller_angle(given)) {
  length = std::min(a.translation.norm(), b.translation.norm());
}

std::vector<StepVerdict> find_jumps(std::span<const MeasuredStep> steps, const Statistics& before, Mode mode,
                                    const std::optional<DualQuaternion>& q, const JumpOptions& options) {
  Judge judge(steps, options);
  if (q) return settle(judge, *q, options.most_rounds);

  std::vector<Statistics> statistics;
  for (const MeasuredStep& measured : steps) {
    const Step& step = measured.step;
    statistics.emplace_back();
    if (step.usable) statistics.back().add(step.a, step.b);
  }
  double balance = options.first_balance;
  double mu = 0;
  std::vector<Jump> jumps;
  for (int round = 0; round < options.most_rounds; ++round) {
    Statistics sum = before;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (!steps[i].step.usable) continue;
      sum.dual_rows += judge.weights[i] * statistics[i].dual_rows;
      sum.weight += judge.weights[i];
    }
    judge.look_from(detail::minimiser(cost_matrix(sum, {balance, 1}), mode));
    balance = judge.rotation_weight();
    const bool sharp = mu == 1;
    mu = round == 0 ? std::max(1.0, 2 * judge.largest_excess()) : std::max(1.0, mu / options.sharpen);
    std::vector<Jump> next = judge.jumps();
    if (sharp && next == jumps) break;
    jumps = std::move(next);
    judge.weigh(mu);
  }
  return judge.verdicts(jumps);
}

}  // namespace egocal
