// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/turning/askew_rotations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/stillest_point.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"
#include "linear_algebra/cross_matrix.hpp"
#include "linear_algebra/normal_equations.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "statistics/distributions.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double tiny = 1e-300;  // against a division by zero: what is not shown, streams without noise

/// Normal equations of n unknowns.
template <int n>
struct Normal {
  Eigen::Matrix<double, n, n> A = Eigen::Matrix<double, n, n>::Zero();
  Eigen::Matrix<double, n, 1> b = Eigen::Matrix<double, n, 1>::Zero();

  void add(double weight, const Eigen::Matrix<double, 3, n>& rows, const Vector3d& residual) {
    add_square(A, weight, rows);
    add_product(b, -weight, rows, residual);
  }
  void add(const Normal& other, double sign) {
    A += sign * other.A;
    b += sign * other.b;
  }
  /// What the motions do not show stays zero. Vectors in threes, each in its own unit; `scalars` from the
  /// first one of three that are not a vector.
  Eigen::Matrix<double, n, 1> solved(int scalars = -1) const {
    // Mathematics: a direction of which the motions show less than this part of the square of all is a ratio
    // of 3e-4 in the motions, which is below the noise of any odometry. What is shown is moved by this part
    // over its own one: by a thousandth where that is 1e-4. Rounding is below 1e-12 of the sums.
    constexpr double part = 1e-7;
    Eigen::Matrix<double, n, n> kept = A;
    for (int i = 0; i < n; i += 3) {
      auto diagonal = kept.diagonal().template segment<3>(i).array();
      if (i == scalars)
        diagonal *= 1 + part;
      else
        diagonal += part * diagonal.sum();
      diagonal += tiny;
    }
    return solve_symmetric(kept, b);
  }
};

/// Sums of one part of the drive. Turns are in the frame of a: x' = x + turn x x.
struct PartSums {
  Normal<3> rotations;  ///< turn of the mounting
  Normal<9> rates;      ///< and a symmetric map of the rotations of b
  /// Lever arm, turn of the mounting; scale of b, and how late its positions and its rotations are, which are
  /// other mistakes.
  Normal<9> positions;
  std::array<Normal<12>, 2> with_worlds;  ///< and a turn in the world of a or b

  void add(const PartSums& other, double sign) {
    rotations.add(other.rotations, sign);
    rates.add(other.rates, sign);
    positions.add(other.positions, sign);
    for (std::size_t side = 0; side < 2; ++side) with_worlds[side].add(other.with_worlds[side], sign);
  }

  /// Turns in the order of Askew::Kind.
  std::array<Vector3d, 4> turns() const {
    const Vector3d by_rotations = rotations.solved();
    return {by_rotations - positions.solved(6).segment<3>(3), with_worlds[0].solved(6).tail<3>(),
            with_worlds[1].solved(6).tail<3>(), by_rotations - rates.solved().head<3>()};
  }
};

/// Residuals at the extrinsic, in the frame of a.
struct LeftOver {
  Vector3d turned, rotation, travelled, translation;  ///< by b, and what is left [rad, m]
};

struct Weights {
  double rotation = 1, translation = 1;
};

std::vector<Weights> weights_of(const std::vector<LeftOver>& residuals, double inlier) {
  std::vector<double> rotations, translations;
  for (const LeftOver& left : residuals) {
    rotations.push_back(left.rotation.squaredNorm());
    translations.push_back(left.translation.squaredNorm());
  }
  const double rotation = median(rotations) + tiny, translation = median(translations) + tiny;
  const auto weight = [inlier](double square, double typical) {
    return std::pow(1 + square / (inlier * typical), -2);
  };
  std::vector<Weights> weights;
  for (std::size_t i = 0; i < residuals.size(); ++i)
    weights.push_back({weight(rotations[i], rotation), weight(translations[i], translation)});
  return weights;
}

/// Turns of all motions of one length, and their covariances by leaving out parts of the drive.
struct Turns {
  std::array<Vector3d, 4> of_all;
  std::array<Matrix3d, 4> covariance;
  std::size_t parts = 0;  ///< 0: too few motions
};

/// J S x of a symmetric S with the elements xx, yy, zz, yz, xz, xy.
Eigen::Matrix<double, 3, 6> symmetric_map_of(const Vector3d& x) {
  Eigen::Matrix<double, 3, 6> rows;
  rows << x[0], 0, 0, 0, x[2], x[1],  //
      0, x[1], 0, x[2], 0, x[0],      //
      0, 0, x[2], x[1], x[0], 0;
  return rows;
}

/// What changes the translation of b from instant `begin` over `span`: its scale, and positions and rotations
/// that are later by a period.
Matrix3d by_scale_and_lags(const Instants& instants, std::size_t begin, std::size_t span,
                           const Vector3d& t_b) {
  const auto step = [&](std::size_t i) {
    const std::size_t from = i == 0 ? 0 : i - 1, to = std::min(i + 1, instants.size() - 1);
    return std::pair(to_pose(instants.at(from).b), to_pose(instants.at(to).b));
  };
  const auto [before, after] = step(begin);
  const auto [end_before, end_after] = step(begin + span);
  const Rotation back = before.rotation.conjugate();
  const Vector3d turned = rotation_log(back * after.rotation);
  Matrix3d columns;
  columns << t_b,
      back * (end_after.translation - end_before.translation - after.translation + before.translation),
      turned.cross(t_b);
  return columns;
}

std::vector<PartSums> sums_of(const Instants& instants, const Motions& motions, const Pose& T,
                              std::size_t parts, const AskewOptions& options) {
  const Matrix3d R = T.rotation.toRotationMatrix();
  std::vector<LeftOver> residuals;
  for (const Motion& motion : motions.all) {
    LeftOver left;
    left.turned = R * rotation_log(to_pose(motion.b).rotation);
    left.rotation = rotation_log(to_pose(motion.a).rotation) - left.turned;
    left.travelled = R * motion.t_b;
    left.translation = motion.R_a * T.translation + motion.t_a - left.travelled - T.translation;
    residuals.push_back(left);
  }
  const std::vector<Weights> weights = weights_of(residuals, options.inlier);
  const std::vector<std::size_t> begins = begins_of(instants, motions);
  const auto span = static_cast<std::size_t>(motions.stride);
  std::vector<PartSums> sums(parts);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const Motion& motion = motions.all[i];
    const LeftOver& left = residuals[i];
    PartSums& part = sums[i * parts / residuals.size()];
    const PosePair begin = instants.at(begins[i]);
    Eigen::Matrix<double, 3, 9> rows;
    rows.leftCols<3>() = cross_matrix(left.turned);
    part.rotations.add(weights[i].rotation, rows.leftCols<3>(), left.rotation);
    rows.rightCols<6>() = -symmetric_map_of(left.turned);
    part.rates.add(weights[i].rotation, rows, left.rotation);
    Eigen::Matrix<double, 3, 12> of_positions;
    of_positions.leftCols<3>() = motion.R_a - Matrix3d::Identity();
    of_positions.middleCols<3>(3) = cross_matrix(left.travelled);
    of_positions.middleCols<3>(6) = -R * by_scale_and_lags(instants, begins[i], span, motion.t_b);
    part.positions.add(weights[i].translation, of_positions.leftCols<9>(), left.translation);
    of_positions.rightCols<3>() = cross_matrix(motion.t_a) * rotation_of(begin.a).transpose();
    part.with_worlds[0].add(weights[i].translation, of_positions, left.translation);
    of_positions.rightCols<3>() = R * cross_matrix(motion.t_b) * rotation_of(begin.b).transpose();
    part.with_worlds[1].add(weights[i].translation, of_positions, left.translation);
  }
  return sums;
}

Turns turns_of(const Instants& instants, int stride, const Pose& T, const MotionSampleOptions& sample,
               const AskewOptions& options) {
  const Motions motions = motions_of(instants, {}, {}, stride, options.motions, sample);
  if (motions.all.empty()) return {};
  const double each = std::max(stride * instants.period, 1e-9);
  const double seconds = motions.all.back().time - motions.all.front().time;
  const std::size_t parts =
      std::min({options.parts,
                static_cast<std::size_t>(static_cast<double>(motions.all.size()) / options.motions_a_part),
                static_cast<std::size_t>(options.parts_a_motion * seconds / each)});
  if (parts < options.least_parts) return {};
  const std::vector<PartSums> sums = sums_of(instants, motions, T, parts, options);
  PartSums all;
  for (const PartSums& part : sums) all.add(part, 1);
  Turns turns{all.turns(), {}, parts};
  turns.covariance.fill(Matrix3d::Zero());
  std::vector<std::array<Vector3d, 4>> without;
  std::array<Vector3d, 4> mean;
  mean.fill(Vector3d::Zero());
  const auto m = static_cast<double>(parts);
  for (const PartSums& part : sums) {
    PartSums others = all;
    others.add(part, -1);
    without.push_back(others.turns());
    for (std::size_t kind = 0; kind < mean.size(); ++kind) mean[kind] += without.back()[kind] / m;
  }
  for (const std::array<Vector3d, 4>& one : without)
    for (std::size_t kind = 0; kind < mean.size(); ++kind) {
      const Vector3d off = one[kind] - mean[kind];
      turns.covariance[kind] += (m - 1) / m * off * off.transpose();
    }
  return turns;
}

/// The surest of the turns of motions of one length that those of the other length show as well.
std::optional<Askew> surest(const Turns& turns, const Turns& other, const AskewOptions& options) {
  std::optional<Askew> found;
  if (turns.parts == 0 || other.parts == 0) return found;
  for (std::size_t kind = 0; kind < turns.of_all.size(); ++kind) {
    const SymmetricEigen<3> eigen = symmetric_eigen<3>(turns.covariance[kind]);
    double square = 0, least_chance = 1;
    for (int i = 0; i < 3; ++i) {
      const Vector3d direction = eigen.vectors.col(i);
      const double turn = direction.dot(turns.of_all[kind]);
      constexpr double rounding = 1e-20;  // of a variance [rad^2]
      const double variance = std::max(eigen.values[i], rounding);
      const double chance = f_exceeded(turn * turn / variance, 1, static_cast<double>(turns.parts - 1));
      if (!(chance < options.chance) || !(direction.dot(other.of_all[kind]) / turn >= options.part_of_other))
        continue;
      square += turn * turn;
      least_chance = std::min(least_chance, chance);
    }
    const Askew here{static_cast<Askew::Kind>(kind), std::sqrt(square), least_chance};
    if (square > 0 && here.turn >= options.least * options.tolerance &&
        (!found || here.chance < found->chance))
      found = here;
  }
  return found;
}

}  // namespace

std::optional<Askew> askew(const Instants& instants, int stride, const DualQuaternion& T_a_b,
                           const MotionSampleOptions& motions, const AskewOptions& options) {
  const Pose T = to_pose(T_a_b);
  const int other = stride > 1 ? std::max(1, stride / options.shorter) : options.shorter;
  const Turns turns = turns_of(instants, stride, T, motions, options),
              of_other = turns_of(instants, other, T, motions, options);
  const std::optional<Askew> one = surest(turns, of_other, options), two = surest(of_other, turns, options);
  if (!one || !two) return one ? one : two;
  return two->chance < one->chance ? two : one;
}

std::optional<Finding> askew_rotations(const Instants& instants, int stride, const Answered& answered,
                                       const DiagnosisOptions& options) {
  AskewOptions tuning;
  tuning.tolerance = options.tolerance_rotation;
  const std::optional<Askew> found = askew(instants, stride, answered.T_a_b, options.motions, tuning);
  if (!found) return std::nullopt;
  const double degrees = found->turn * degrees_per_radian;
  Finding finding;
  finding.code = "odometry";
  std::string claim, cure = "Calibrate the gyroscopes and the axes of both odometries, then record again.";
  switch (found->kind) {
    case Askew::Kind::against_positions:
      claim = format(
          "The rotations show a mounting that is turned by %.2g deg against the one that the "
          "positions show, in all of the drive: the rotations of one odometry are askew.",
          degrees);
      break;
    case Askew::Kind::world_a:
    case Askew::Kind::world_b:
      claim = format(
          "The positions of %s are turned by %.2g deg against its rotations, in its world: the "
          "rotations of one odometry are askew, or its positions are in another frame.",
          mark(found->kind == Askew::Kind::world_a ? 'a' : 'b'), degrees);
      break;
    case Askew::Kind::of_rates:
      claim = format(
          "The rotations of one stream are those of the other one about axes that are not at right "
          "angles, or by unlike factors: without that the answer is turned by %.2g deg.",
          degrees);
      break;
  }
  say(finding, std::move(claim), std::move(cure));
  return finding;
}

}  // namespace egocal::detail
