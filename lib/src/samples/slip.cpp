// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/slip.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// The normal equations of one unit or several, of X (frame_a_moved()) and Y together, in variances.
struct Normal {
  Matrix12d H = Matrix12d::Zero();
  Vector12d g = Vector12d::Zero();
  double squares = 0;

  Normal& operator+=(const Normal& other) {
    H += other.H;
    g += other.g;
    squares += other.squares;
    return *this;
  }
};

Normal normal_of(const SampleSet& set, std::size_t i, const SampleFit& fit, double weight) {
  const Eigen::Matrix3d R_a = to_pose(set.sample(i).a).rotation.toRotationMatrix();
  const Pose y = to_pose(set.seen(i).with(fit.X)), Y = to_pose(fit.Y), X = to_pose(fit.X);
  const Eigen::Vector3d c = X.rotation * to_pose(conjugate(set.sample(i).b)).translation;
  Eigen::Matrix<double, 6, 12> J;
  Vector6d r;
  r << y.translation - Y.translation, rotation_log(y.rotation * Y.rotation.conjugate());
  Eigen::Matrix3d cross;
  cross << 0, -c.z(), c.y(), c.z(), 0, -c.x(), -c.y(), c.x(), 0;
  // y = a X b^-1: dp = R_a (dt + dtheta x c), dtheta_y = R_a dtheta
  J << R_a, -R_a * cross, -Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), R_a,
      Eigen::Matrix3d::Zero(), -Eigen::Matrix3d::Identity();
  Vector6d precision;
  precision << Eigen::Vector3d::Constant(1 / fit.noise.translation),
      Eigen::Vector3d::Constant(1 / fit.noise.rotation);
  precision *= weight;
  Normal one;
  one.H = J.transpose() * precision.asDiagonal() * J;
  one.g = -(J.transpose() * precision.asDiagonal() * r);
  one.squares = r.dot(precision.asDiagonal() * r);
  return one;
}

/// The units of some samples, in the order of their first ones, and their normal equations.
struct PlacedUnit {
  std::size_t first = 0;  ///< sample
  std::size_t given = 0;  ///< place among the samples given
  Normal normal;
};
std::vector<PlacedUnit> units_in(const SampleSet& set, const std::vector<bool>& counts, const SampleFit& fit,
                                 const std::vector<std::size_t>& order,
                                 const std::vector<std::size_t>& given) {
  std::vector<double> members(set.units(), 0.0);
  for (const std::size_t i : order) members[set.unit(i)] += counts[i] ? 1 : 0;
  std::vector<std::size_t> place(set.units(), set.size());
  std::vector<PlacedUnit> units;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    if (!counts[i]) continue;
    std::size_t& at = place[set.unit(i)];
    if (at == set.size()) {
      at = units.size();
      units.push_back({i, given[k], {}});
    }
    units[at].normal += normal_of(set, i, fit, 1 / members[set.unit(i)]);
  }
  return units;
}

/// The division that explains most.
struct Slip {
  std::size_t at = 0;  ///< first unit after it
  bool of_target = false;
  double gain = 0;                    ///< of the cost, in variances
  Vector6d after = Vector6d::Zero();  ///< change of X
  double shift = 0, turn = 0;         ///< [m, rad]
};

constexpr double ridge = 1e-9;  // rounding: along a direction that nothing shows nothing slips

/// The answer of all units, without a slip.
struct Undivided {
  Eigen::LDLT<Matrix12d> factor;
  Vector12d moved;     ///< from the fit
  double squares = 0;  ///< that are left

  explicit Undivided(const std::vector<PlacedUnit>& units) {
    Normal all;
    for (const PlacedUnit& unit : units) all += unit.normal;
    all.H.diagonal() *= 1 + ridge;
    factor.compute(all.H);
    moved = factor.solve(all.g);
    squares = all.squares - all.g.dot(moved);
  }
};

Slip best_division(const std::vector<PlacedUnit>& units, const std::vector<std::size_t>& order,
                   const Undivided& undivided, const SlipOptions& options) {
  const Eigen::LDLT<Matrix12d>& factor = undivided.factor;
  const Vector12d& of_all = undivided.moved;
  const std::size_t n = units.size();
  const std::size_t step = (n + options.most_places - 1) / options.most_places;
  Slip best;
  Normal after;
  for (std::size_t at = n; at-- > options.least_part;) {
    after += units[order[at]].normal;
    if (n - at < options.least_part || at % step != 0) continue;
    for (const bool of_target : {false, true}) {
      const Eigen::Index first = of_target ? 6 : 0;
      const Eigen::Matrix<double, 12, 6> across = after.H.middleCols<6>(first);
      Matrix6d S = after.H.block<6, 6>(first, first) - across.transpose() * factor.solve(across);
      S.diagonal() += ridge * after.H.diagonal().segment<6>(first);
      const Vector6d h = after.g.segment<6>(first) - across.transpose() * of_all;
      const Vector6d moved = S.ldlt().solve(h);
      const double gain = h.dot(moved);
      if (!(gain > best.gain)) continue;
      const Vector12d rest = of_all - factor.solve(across * moved);
      best = {at, of_target, gain, rest.head<6>(), moved.head<3>().norm(), moved.tail<3>().norm()};
      if (!of_target) best.after += moved;
    }
  }
  return best;
}

/// Gain of the best division by where the samples are: along the positions and the rotations of a.
double gain_of_other_orders(const SampleSet& set, const std::vector<PlacedUnit>& units,
                            const Undivided& undivided, const SlipOptions& options) {
  double largest = 0;
  std::vector<Vector6d> places;
  const Pose first = to_pose(set.sample(units.front().first).a);
  for (const PlacedUnit& unit : units) {
    const Pose a = to_pose(set.sample(unit.first).a);
    Vector6d place;
    place << a.translation, rotation_log(first.rotation.conjugate() * a.rotation);
    places.push_back(place);
  }
  std::vector<std::size_t> order(units.size());
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
      return places[i][axis] == places[j][axis] ? i < j : places[i][axis] < places[j][axis];
    });
    largest = std::max(largest, best_division(units, order, undivided, options).gain);
  }
  return largest;
}

std::optional<Finding> slip_among(const SampleSet& set, const std::vector<PlacedUnit>& units,
                                  const SampleFit& fit, double most_variance, const SampleNames& names,
                                  bool metres, const SlipOptions& options) {
  const std::size_t n = units.size();
  if (n < 2 * options.least_part) return std::nullopt;
  std::vector<std::size_t> as_given(n);
  std::iota(as_given.begin(), as_given.end(), std::size_t{0});
  const Undivided undivided(units);
  const Slip slip = best_division(units, as_given, undivided, options);
  const double squares = undivided.squares;
  constexpr double of_pose = 6;  // mathematics: numbers of a pose
  const double dof = of_pose * (static_cast<double>(n) - 3);
  const double left = squares - slip.gain, variance = left / dof;
  if (!(dof > 0) || !(left > 0) || variance > most_variance) return std::nullopt;
  const double places = 2 * static_cast<double>(std::min(n, options.most_places));
  if (f_exceeded(slip.gain / of_pose / variance, of_pose, dof) * places > options.by_chance)
    return std::nullopt;
  const double gain = squares / (dof + of_pose) / variance;
  if (gain < options.least_gain) return std::nullopt;
  if (slip.gain < options.than_other_orders * gain_of_other_orders(set, units, undivided, options))
    return std::nullopt;
  return worded_slip({units[slip.at].given, slip.of_target, slip.shift, slip.turn, gain,
                      to_pose(frame_a_moved(fit.X, slip.after))},
                     names, metres, gain > options.certain_gain);
}

}  // namespace

Finding worded_slip(const FoundSlip& slip, const SampleNames& names, bool metres, bool certain) {
  Finding finding;
  finding.code = "mount_moved";
  finding.certain = certain;
  finding.change = MountingChange::at_once;
  finding.improvement = slip.gain;
  finding.T_a_b = slip.after;
  finding.message = format(
      "From about %s on (%s) %s is elsewhere, by %s and %.2g deg: the squared residuals are %.3g times "
      "smaller with two places.",
      full_name_of(names, slip.sample).c_str(), names.order.c_str(),
      slip.of_target ? "the target" : "the camera", length_in_words(slip.shift, metres).c_str(),
      slip.turn * degrees_per_radian, slip.gain);
  finding.remedy = format("Fasten camera and target. Calibrate the samples before and after %s separately.",
                          name_of(names, slip.sample).c_str());
  return finding;
}

std::optional<Finding> find_slip(const SampleSet& set, const AgreeingSamples& agreeing,
                                 const std::vector<std::size_t>& order, const std::vector<std::size_t>& given,
                                 const SampleNames& names, bool metres, const SlipOptions& options) {
  std::vector<bool> counts(set.size(), false);
  for (const std::size_t i : agreeing.chosen) counts[i] = true;
  const std::vector<PlacedUnit> units = units_in(set, counts, agreeing.fit, order, given);
  std::optional<Finding> found =
      slip_among(set, units, agreeing.fit, std::numeric_limits<double>::infinity(), names, metres, options);
  if (found || set.size() - agreeing.chosen.size() < options.least_part) return found;
  const std::vector<PlacedUnit> all =
      units_in(set, std::vector<bool>(set.size(), true), agreeing.fit, order, given);
  return slip_among(set, all, agreeing.fit, options.as_good * agreeing.fit.variance, names, metres, options);
}

}  // namespace egocal::detail
