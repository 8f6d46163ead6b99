// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/goal/manoeuvres.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "egocal/problem/cost.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// A manoeuvre as it is seen by its motions of about a second: amplitudes of turning [rad] and travel, in the
/// frame forward, left, up of a vehicle (of sensor a for what has no forward).
struct Manoeuvre {
  const char* words;
  Eigen::Vector3d turn;    ///< amplitude about forward, left, up
  Eigen::Vector3d travel;  ///< part of the typical length of a motion; bumps are driven slowly
  bool turns_alternate;    ///< from side to side; otherwise one way all the time
};

constexpr double degree = std::numbers::pi / 180;
/// Motions that one manoeuvre gives: 16 s at a motion a second. Part of the catalogue, which ranks manoeuvres
/// against each other; changes no answer.
constexpr int motions_each = 16;
constexpr double motions_per_second = 1;  ///< at most
/// A manoeuvre is advised where it reaches the goal within this part of the time that more of the same takes.
constexpr double most_of_the_time = 0.5;

const char* as_before(Platform platform) {
  if (platform == Platform::car) return "Drive on as before: no manoeuvre would be much faster.";
  return "Go on as before: no manoeuvre would be much faster.";
}

std::vector<Manoeuvre> catalogue(Platform platform) {
  using V = Eigen::Vector3d;
  if (platform == Platform::car)
    return {
        {"Drive tight curves both ways: a figure eight, twice.", V(0, 0, 20) * degree, V(0.6, 0, 0), true},
        {"Drive a slalom.", V(1, 0, 8) * degree, V(0.7, 0, 0), true},
        {"Drive straight over speed bumps or a ramp, five times.", V(0, 4, 0) * degree, V(0.4, 0, 0), true},
        {"Drive over a kerb or a ramp at an angle, both ways, five times.", V(4, 4, 2) * degree, V(0.3, 0, 0),
         true},
        {"Drive banked curves.", V(3, 1, 10) * degree, V(0.8, 0, 0), false},
        {"Drive straight on for a while.", V(0, 0, 0.5) * degree, V(1, 0, 0), true}};
  const bool arm = platform == Platform::arm, drone = platform == Platform::drone;
  return {{arm     ? "Turn the hand about its x axis, both ways, by 30 degrees and more."
           : drone ? "Fly sideways, left and right, with strong roll."
                   : "Tilt the rig about its x axis, both ways, five times.",
           V(20, 0, 0) * degree, V(0.2, 0.5, 0.2), true},
          {arm     ? "Turn the hand about its y axis, both ways, by 30 degrees and more."
           : drone ? "Fly forward and back, with strong pitch."
                   : "Tilt the rig about its y axis, both ways, five times.",
           V(0, 20, 0) * degree, V(0.5, 0.2, 0.2), true},
          {arm     ? "Turn the hand about its z axis, both ways, by 30 degrees and more."
           : drone ? "Yaw left and right by half a turn while you fly a circle."
                   : "Turn the rig about its z axis, both ways, five times.",
           V(0, 0, 20) * degree, V(0.5, 0.5, 0), true},
          {arm     ? "Move the hand to and fro along all three axes without turning it."
           : drone ? "Climb and descend, and fly to all four sides."
                   : "Move the rig along all three axes without turning it.",
           V(0.5, 0.5, 0.5) * degree, V(1, 1, 1), true}};
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

/// Rotations of a: D holds sum of |a_v|^2 I - a_v a_v' twice over, seen through the extrinsic. Its direction
/// of least curvature for the translation is the axis that was turned about most.
Body body_of(const Answered& answered, const Matrix6d& shown) {
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
  const Matrix8d Q = cost_matrix(answered.problem);
  const double weight = std::max(1e-12, answered.problem.balance.translation);
  const double of_rotation = answered.problem.balance.rotation / weight * Q.bottomRightCorner<4, 4>().trace();
  const double length2 = (Q.topLeftCorner<4, 4>().trace() - of_rotation) / (2 * weight);
  body.length = std::clamp(std::sqrt(std::max(0.0, length2)), 0.05, 50.0);
  return body;
}

Matrix6d information_of(const Manoeuvre& manoeuvre, const Body& body, const Answered& answered,
                        bool vehicle) {
  Statistics statistics;
  const DualQuaternion T = answered.T_a_b;
  const Eigen::Matrix3d axes = vehicle ? body.axes : Eigen::Matrix3d::Identity();
  for (int i = 0; i < motions_each; ++i) {
    const double phase = 2 * std::numbers::pi * (i + 0.5) / motions_each;
    // out of step, so that the axes are shown by themselves
    const Eigen::Vector3d wave(std::sin(phase), std::cos(phase), std::sin(2 * phase));
    Eigen::Vector3d turn = manoeuvre.turn, travel = manoeuvre.travel;
    if (manoeuvre.turns_alternate) turn = turn.cwiseProduct(wave);
    if (!vehicle) travel = travel.cwiseProduct(Eigen::Vector3d(wave.z(), wave.x(), wave.y()));
    const DualQuaternion a = to_dual_quaternion({rotation_exp(axes * turn), body.length * (axes * travel)});
    statistics.add(a, conjugate(T) * a * T);
  }
  return information(cost_matrix(statistics, answered.problem.balance), T);
}

}  // namespace

std::string next_manoeuvre(const Answered& answered, const GoalOptions& options,
                           const std::vector<Missing>& missing, std::optional<double> seconds_left,
                           double exponent) {
  const Problem& problem = answered.problem;
  if (problem.mode == Mode::planar) return "Drive curves both ways: a figure eight, twice.";
  const Matrix8d Q = cost_matrix(problem);
  if (!(Q.diagonal().maxCoeff() > 0)) return "Move, with turns.";
  const Matrix6d shown = information(Q, answered.T_a_b);
  const Body body = body_of(answered, shown);
  const Platform platform = options.platform.value_or(answered.platform);

  // the drive counts as many motions as its spreads say, its own directions as they are shown
  double count = 0;
  const Matrix6d regular = shown + 1e-9 * shown.diagonal().sum() * Matrix6d::Identity();
  const Matrix6d inverse = regular.ldlt().solve(Matrix6d::Identity());
  const double noise = std::max(cost(Q, answered.T_a_b), 1e-12 * Q.trace());
  for (std::size_t i = 0; i < 6; ++i) {
    const int k = static_cast<int>(i);
    const double stddev = answered.observability.stddev[i];
    if (answered.observability.observable[i] && std::isfinite(stddev) && stddev > 0)
      count = std::max(count, noise * inverse(k, k) / (stddev * stddev));
  }
  count = std::clamp(count, 1.0, 1e6);

  // what rotation noise alone makes of the curvature is no knowledge
  const double rotation_noise =
      std::max(0.0, answered.T_a_b.real.dot(Q.bottomRightCorner<4, 4>() * answered.T_a_b.real));
  Matrix6d known = shown;
  known.diagonal().head<3>().array() -= 0.75 * rotation_noise;
  const SymmetricEigen<6> spectrum = symmetric_eigen<6>(known);
  known = spectrum.vectors * spectrum.values.cwiseMax(0.0).asDiagonal() * spectrum.vectors.transpose();

  const auto covariance_with = [&](const Matrix6d& added) {
    Matrix6d sum = count * known + added;
    sum += 1e-12 * sum.diagonal().cwiseAbs().sum() * Matrix6d::Identity();
    return Matrix6d(noise * sum.ldlt().solve(Matrix6d::Identity()));
  };
  const Matrix6d now = covariance_with(Matrix6d::Zero());
  // of the direction that is known worst then: its standard deviation as a part of the wanted one
  const auto worst_with = [&](const Matrix6d& added) {
    const Matrix6d covariance = covariance_with(added);
    double worst = 0;
    for (const auto& [ratio, i] : missing) {
      const int k = static_cast<int>(i);
      const double wanted = i < 3 ? options.translation : options.rotation;
      // from its own spread, where it has one, and as spreads fall with the information
      worst = std::max(worst, std::isfinite(ratio)
                                  ? ratio * std::pow(std::abs(covariance(k, k) / now(k, k)), exponent)
                                  : std::sqrt(std::abs(covariance(k, k))) / wanted);
    }
    return worst;
  };
  // a manoeuvre again and again, against more of what was driven so far: as many motions as the drive counts
  // for in this time
  const double rate =
      answered.seconds > 0 ? std::min(motions_per_second, count / answered.seconds) : motions_per_second;
  const double number = seconds_left ? most_of_the_time * *seconds_left * rate : motions_each;
  const char* best = "";
  double least = INFINITY;
  for (const Manoeuvre& manoeuvre : catalogue(platform)) {
    const double worst =
        worst_with(number * information_of(manoeuvre, body, answered, platform == Platform::car));
    if (worst < least) {
      least = worst;
      best = manoeuvre.words;
    }
  }
  if (!(answered.seconds > 0)) return best;
  // twice the information of the same driving in the same time, or it is not worth a detour
  const Matrix6d more_of_the_same = number / (rate * answered.seconds) * count * known;
  const bool helps = least <= std::pow(most_of_the_time, exponent) * worst_with(more_of_the_same);
  return helps && (!seconds_left || least <= 1) ? best : as_before(platform);
}

}  // namespace egocal::detail
