// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/goal/manoeuvres.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "diagnosis/goal/motion_information.hpp"
#include "egocal/degrees.hpp"
#include "egocal/problem/cost.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/takes_off.hpp"
#include "uncertainty/tangent_form.hpp"

namespace egocal::detail {

namespace {

/// A manoeuvre: amplitudes of turning [rad/s] and travel, in the frame forward, left, up of a vehicle (of
/// sensor a for what has no forward).
struct Manoeuvre {
  const char* words;
  Eigen::Vector3d turn;    ///< amplitude about forward, left, up, in a second
  Eigen::Vector3d travel;  ///< part of the typical length of a motion; bumps are driven slowly
  bool turns_alternate;    ///< from side to side; otherwise one way all the time
};

/// Motions of a manoeuvre that its information is the mean of: enough for products of waves up to twice the
/// slowest. Changes no answer.
constexpr int motions_each = 8;
/// How long a manoeuvre takes [s]: part of the catalogue, as it is driven in manoeuvre_study. Of several that
/// help, the one that brings most in this time is advised.
constexpr double manoeuvre_seconds = 16;
/// A turn to one side lasts this long [s]: longer motions turn no further. Part of the catalogue.
constexpr double turn_seconds = 1;
/// A manoeuvre is advised where a direction reaches the goal by it within this part of the time that more of
/// the same takes. With 0.5, 76 of 86 that manoeuvre_study advises halve the time to the goal (seeds 1 and
/// 501, 10 drives of each kind); with 0.25, 62 of 67, but 13 of 20 hand-held drives lose a right advice.
constexpr double most_of_the_time = 0.5;
/// Standard deviations of more goals than this count as this: nothing is known of such a direction yet.
constexpr double hardly_known = 100;

const char* as_before(Platform platform) {
  if (platform == Platform::car) return "Drive on as before: no manoeuvre would be much faster.";
  return "Go on as before: no manoeuvre would be much faster.";
}

std::vector<Manoeuvre> catalogue(Platform platform) {
  using V = Eigen::Vector3d;
  if (platform == Platform::car)
    return {{"Drive tight curves both ways: a figure eight, twice.", V(0, 0, 20) * radians_per_degree,
             V(0.6, 0, 0), true},
            {"Drive a slalom.", V(1, 0, 8) * radians_per_degree, V(0.7, 0, 0), true},
            {"Drive straight over speed bumps or a ramp, five times.", V(0, 4, 0) * radians_per_degree,
             V(0.4, 0, 0), true},
            {"Drive over a kerb or a ramp at an angle, both ways, five times.",
             V(4, 4, 2) * radians_per_degree, V(0.3, 0, 0), true},
            {"Drive banked curves.", V(3, 1, 10) * radians_per_degree, V(0.8, 0, 0), false},
            {"Drive straight on for a while.", V(0, 0, 0.5) * radians_per_degree, V(1, 0, 0), true}};
  const bool arm = platform == Platform::arm, drone = platform == Platform::drone;
  return {{arm     ? "Turn the hand about its x axis, both ways, by 30 degrees and more."
           : drone ? "Fly sideways, left and right, with strong roll."
                   : "Tilt the rig about its x axis, both ways, five times.",
           V(20, 0, 0) * radians_per_degree, V(0.2, 0.5, 0.2), true},
          {arm     ? "Turn the hand about its y axis, both ways, by 30 degrees and more."
           : drone ? "Fly forward and back, with strong pitch."
                   : "Tilt the rig about its y axis, both ways, five times.",
           V(0, 20, 0) * radians_per_degree, V(0.5, 0.2, 0.2), true},
          {arm     ? "Turn the hand about its z axis, both ways, by 30 degrees and more."
           : drone ? "Yaw left and right by half a turn while you fly a circle."
                   : "Turn the rig about its z axis, both ways, five times.",
           V(0, 0, 20) * radians_per_degree, V(0.5, 0.5, 0), true},
          {arm     ? "Move the hand to and fro along all three axes without turning it."
           : drone ? "Climb and descend, and fly to all four sides."
                   : "Move the rig along all three axes without turning it.",
           V(0.5, 0.5, 0.5) * radians_per_degree, V(1, 1, 1), true}};
}

/// What the drive so far says of the vehicle: the axis that it turns about most is up, and its way forward.
struct Body {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< forward, left, up in sensor a
  double length = 1;                                   ///< of a typical motion [m]
};

/// Information about (dt, dtheta) in sensor a's frame per unit of weight.
Matrix6d information(const Matrix8d& Q, const DualQuaternion& q) {
  const Matrix86d T = frame_a_basis(q);
  return T.transpose() * lagrangian_matrix(Q, least_squares_multipliers(Q, q)) * T;
}

/// shown: information() of Q. Rotations of a: D holds sum of |a_v|^2 I - a_v a_v' twice over, seen through
/// the extrinsic. Its direction of least curvature for the translation is the axis that was turned about
/// most.
Body body_of(const Answered& answered, const Matrix8d& Q, const Matrix6d& shown) {
  Body body;
  const Eigen::Vector3d up = symmetric_eigen<3>(shown.topLeftCorner<3, 3>()).vectors.col(0);
  // rotations about the way forward change the translations least
  Eigen::Vector3d forward = symmetric_eigen<3>(shown.bottomRightCorner<3, 3>()).vectors.col(0);
  forward -= forward.dot(up) * up;
  if (forward.norm() < 0.1) forward = up.unitOrthogonal();
  forward.normalize();
  body.axes << forward, up.cross(forward), up;
  // the upper left block is (16)'s rotation part, which the lower right one holds as well, and for each
  // motion 4 (|a_d|^2 + |b_d|^2), about twice its squared length
  const double weight = std::max(1e-12, answered.problem.balance.translation);
  const double of_rotation = answered.problem.balance.rotation / weight * Q.bottomRightCorner<4, 4>().trace();
  const double length2 = (Q.topLeftCorner<4, 4>().trace() - of_rotation) / (2 * weight);
  body.length = std::clamp(std::sqrt(std::max(0.0, length2)), 0.05, 50.0);
  return body;
}

/// Factors of the amplitudes of a manoeuvre along three axes, one vector for each of its motions. They are
/// out of step, so that each axis is shown by itself.
const std::array<Eigen::Vector3d, motions_each>& waves() {
  static const std::array<Eigen::Vector3d, motions_each> all = [] {
    std::array<Eigen::Vector3d, motions_each> result;
    double phase = std::numbers::pi / motions_each;
    for (Eigen::Vector3d& wave : result) {
      wave = {std::sin(phase), std::cos(phase), std::sin(2 * phase)};
      phase += 2 * std::numbers::pi / motions_each;
    }
    return result;
  }();
  return all;
}

/// Mean information of the motions of a manoeuvre that are as long as those of the drive. seconds: that one
/// of these takes. Where noise falls with the speed, slow manoeuvres are better than that: one drive does not
/// say whether it does.
Matrix6d information_of(const Manoeuvre& manoeuvre, const Body& body, const Answered& answered,
                        double seconds, bool vehicle) {
  MotionProducts sums;
  const Eigen::Matrix3d axes = vehicle ? body.axes : Eigen::Matrix3d::Identity();
  for (const Eigen::Vector3d& wave : waves()) {
    Eigen::Vector3d turn = std::min(seconds, turn_seconds) * manoeuvre.turn, travel = manoeuvre.travel;
    if (manoeuvre.turns_alternate) turn = turn.cwiseProduct(wave);
    if (!vehicle) travel = travel.cwiseProduct(Eigen::Vector3d(wave.z(), wave.x(), wave.y()));
    sums.add({rotation_exp(axes * turn), body.length * (axes * travel)});
  }
  const Eigen::Vector3d t = to_pose(answered.T_a_b).translation;
  return information_of(sums, t, answered.problem.balance) / motions_each;
}

/// How long one motion took [s]: they begin at every instant.
double seconds_of_a_motion(const Answered& answered) {
  double instants = answered.stride;
  for (const Statistics& block : answered.problem.blocks)
    if (!takes_off(block)) instants += static_cast<double>(block.count);
  return answered.seconds > 0 ? answered.seconds * answered.stride / instants : turn_seconds;
}

/// Standard deviations after a manoeuvre of some seconds. That goes in by its length against the drive's, so
/// the noise cancels: a manoeuvre has as much of it in a second.
class Forecast {
 public:
  /// Q: cost_matrix() of the problem. shown: its information().
  Forecast(const Answered& answered, const Matrix8d& Q, const Matrix6d& shown, const GoalOptions& options)
      : known_(shown), seconds_(answered.seconds > 0 ? answered.seconds : manoeuvre_seconds) {
    // what rotation noise alone makes of the curvature is no knowledge
    const DualQuaternion& T = answered.T_a_b;
    const double rotation_noise = std::max(0.0, T.real.dot(Q.bottomRightCorner<4, 4>() * T.real));
    known_.diagonal().head<3>().array() -= 0.75 * rotation_noise;
    const SymmetricEigen<6> spectrum = symmetric_eigen<6>(known_);
    known_ = spectrum.vectors * spectrum.values.cwiseMax(0.0).asDiagonal() * spectrum.vectors.transpose();
    forget_what_is_not_shown(answered.observability.observable);
    now_ = inverse(known_).diagonal();

    // Variance of what the drive does not show, per unit of the inverse: the largest of those that it shows,
    // as their noise may wander. The residuals alone, where it shows nothing.
    double unit = 0;
    for (int k = 0; k < 6; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double stddev = answered.observability.stddev[i];
      if (answered.observability.observable[i] && std::isfinite(stddev) && now_[k] > 0)
        unit = std::max(unit, stddev * stddev / now_[k]);
    }
    if (!(unit > 0)) unit = std::max(cost(Q, T), 1e-12 * Q.trace());
    wanted_.head<3>().setConstant(options.translation / std::sqrt(unit));
    wanted_.tail<3>().setConstant(options.rotation / std::sqrt(unit));
  }

  /// The variance of a direction that is this many times the wanted standard deviation: inverse of ratio().
  double variance_at(double ratio, const Missing& missing, double exponent) const {
    const auto k = static_cast<int>(missing.second);
    return std::isfinite(missing.first) ? now_[k] * std::pow(ratio / missing.first, 1 / exponent)
                                        : std::pow(ratio * wanted_[k], 2);
  }
  /// Whether the variance of direction k falls to that after some seconds of a manoeuvre. information: mean
  /// of its motions.
  bool falls_to(double variance, double seconds, const Matrix6d& information, int k) const {
    Matrix6d factors = regular(known_ + seconds / seconds_ * information);
    if (variance * factors(k, k) < 1) return false;  // no variance is below the inverse of its own curvature
    if (!factorise(factors)) return false;
    Vector6d column = Vector6d::Unit(k);
    solve_factorised(factors, column);
    return std::abs(column[k]) <= variance;
  }
  double after_the_same(double seconds, const Missing& missing, double exponent) const {
    return ratio(now_ / (1 + seconds / seconds_), missing, exponent);
  }

  /// How far all missing directions are from the goal, now and after one manoeuvre.
  double needs_now(const std::vector<Missing>& missing, double exponent) const {
    return needs(now_, missing, exponent);
  }
  double needs_after(const Matrix6d& information, const std::vector<Missing>& missing,
                     double exponent) const {
    const Vector6d then = inverse(known_ + manoeuvre_seconds / seconds_ * information).diagonal();
    return needs(then, missing, exponent);
  }

 private:
  /// Logarithm of how far a direction is from the goal; beyond it a reserve counts less and less.
  static double need(double ratio) { return 0.5 * std::log1p(std::pow(std::min(ratio, hardly_known), 2)); }
  double needs(const Vector6d& variances, const std::vector<Missing>& missing, double exponent) const {
    double sum = 0;
    for (const Missing& direction : missing) sum += need(ratio(variances, direction, exponent));
    return sum;
  }
  double ratio(const Vector6d& variances, const Missing& missing, double exponent) const {
    const auto k = static_cast<int>(missing.second);
    // from its own spread, where it has one, and as spreads fall with the information
    return std::isfinite(missing.first) ? missing.first * std::pow(std::abs(variances[k] / now_[k]), exponent)
                                        : std::sqrt(std::abs(variances[k])) / wanted_[k];
  }

  /// Directions that are not shown may have any value: what is known of the others with them free.
  void forget_what_is_not_shown(const std::array<bool, 6>& observable) {
    const double small = 1e-12 * known_.trace();
    for (int k = 0; k < 6; ++k) {
      if (observable[static_cast<std::size_t>(k)]) continue;
      const Vector6d column = known_.col(k);
      if (column[k] > small) known_ -= column * column.transpose() / column[k];
      known_.col(k).setZero();
      known_.row(k).setZero();
    }
  }
  static Matrix6d regular(const Matrix6d& information) {
    return information + 1e-12 * information.diagonal().cwiseAbs().sum() * Matrix6d::Identity();
  }
  static Matrix6d inverse(const Matrix6d& information) {
    Matrix6d factors = regular(information), result = Matrix6d::Constant(NAN);
    if (!factorise(factors)) return result;
    for (int k = 0; k < 6; ++k) {
      Vector6d column = Vector6d::Unit(k);
      solve_factorised(factors, column);
      result.col(k) = column;
    }
    return result;
  }

  Matrix6d known_;   ///< mean information of the drive's motions
  Vector6d now_;     ///< diagonal of its inverse
  Vector6d wanted_;  ///< goals, in roots of that
  double seconds_;   ///< that the drive took
};

/// Whether each manoeuvre is worth a detour: it brings a missing direction to the goal much faster than the
/// same driving. A direction that is there before others, which take their time anyway, does not count.
/// shown: of each manoeuvre. seconds: that the drive took.
std::vector<bool> worth_a_detour(const Forecast& forecast, const std::vector<Matrix6d>& shown,
                                 const std::vector<Missing>& missing, double seconds, double exponent) {
  std::vector<double> gained(shown.size());  // the longest time as before that a manoeuvre saves half of [s]
  double rest = 0;                           // and that none saves
  for (const Missing& direction : missing) {
    const bool ends = std::isfinite(direction.first);
    const double as_before =
        ends ? seconds * std::max(0.0, std::pow(direction.first, 1 / exponent) - 1) : INFINITY;
    const double tried = ends ? most_of_the_time * as_before : manoeuvre_seconds;
    // twice the information of the same driving, where that has no end
    const double enough =
        ends ? 1 : std::pow(most_of_the_time, exponent) * forecast.after_the_same(tried, direction, exponent);
    const double variance = forecast.variance_at(enough, direction, exponent);
    bool any = false;
    for (std::size_t m = 0; m < shown.size(); ++m) {
      if (!forecast.falls_to(variance, tried, shown[m], static_cast<int>(direction.second))) continue;
      any = true;
      gained[m] = std::max(gained[m], as_before);
    }
    if (!any && ends) rest = std::max(rest, as_before);
  }
  std::vector<bool> worth;
  for (const double time : gained) worth.push_back(time > 0 && rest <= most_of_the_time * time);
  return worth;
}

}  // namespace

std::string next_manoeuvre(const Answered& answered, const GoalOptions& options,
                           const std::vector<Missing>& missing, double exponent) {
  const Problem& problem = answered.problem;
  if (problem.mode == Mode::planar) return "Drive curves both ways: a figure eight, twice.";
  const Matrix8d Q = cost_matrix(problem);
  if (!(Q.diagonal().maxCoeff() > 0)) return "Move, with turns.";
  const Matrix6d known = information(Q, answered.T_a_b);
  const Body body = body_of(answered, Q, known);
  const Platform platform = options.platform.value_or(answered.platform);
  const std::vector<Manoeuvre> manoeuvres = catalogue(platform);
  const double each = seconds_of_a_motion(answered);
  std::vector<Matrix6d> shown;
  shown.reserve(manoeuvres.size());
  for (const Manoeuvre& manoeuvre : manoeuvres)
    shown.push_back(information_of(manoeuvre, body, answered, each, platform == Platform::car));
  const Forecast forecast(answered, Q, known, options);

  std::vector<bool> worth(shown.size(), true);
  if (answered.seconds > 0) worth = worth_a_detour(forecast, shown, missing, answered.seconds, exponent);

  const char* best = nullptr;
  double least = forecast.needs_now(missing, exponent);
  for (std::size_t m = 0; m < shown.size(); ++m) {
    const double needs = worth[m] ? forecast.needs_after(shown[m], missing, exponent) : least;
    if (needs < least) {
      least = needs;
      best = manoeuvres[m].words;
    }
  }
  return best ? best : as_before(platform);
}

}  // namespace egocal::detail
