// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "baselines/usable.hpp"
#include "egocal/baselines/baselines.hpp"
#include "linear_algebra/symmetric_eigen.hpp"

namespace egocal {
namespace {

/// Triangular factor of the stacked vector rows of q_a q - q q_b = 0, six for each pair. QR and not S'S:
/// squaring would lose half of the digits of the small singular values.
Matrix8d stacked_factor(const std::vector<MotionPair>& pairs) {
  Eigen::Matrix<double, Eigen::Dynamic, 8> S(6 * static_cast<Eigen::Index>(pairs.size()) + 8, 8);
  S.bottomRows<8>().setZero();  // at least as many rows as columns
  Eigen::Index row = 0;
  for (const MotionPair& pair : pairs) {
    const Matrix8d M =
        std::sqrt(pair.eta) * (left_matrix(canonical_sign(pair.a)) - right_matrix(canonical_sign(pair.b)));
    S.middleRows<3>(row) = M.middleRows<3>(1);
    S.middleRows<3>(row + 3) = M.middleRows<3>(5);
    row += 6;
  }
  const Eigen::HouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 8>> qr(S);
  return qr.matrixQR().topRows<8>().triangularView<Eigen::Upper>();
}

/// Second moment of the half rotation vectors of a and of b across their principal direction, the smaller of
/// both, over what noise contributes to it.
double axis_signal(const std::vector<MotionPair>& pairs) {
  const auto across = [&](auto side) {
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const MotionPair& pair : pairs) {
      const Eigen::Vector3d axis = side(pair).real.template tail<3>();
      moments += pair.eta * axis * axis.transpose();
    }
    const Eigen::Vector3d values = detail::symmetric_eigen<3>(moments).values;
    return std::max(0.0, values[1] - 1e-14 * values[2]);
  };
  const double moment = std::min(across([](const MotionPair& p) { return p.a; }),
                                 across([](const MotionPair& p) { return p.b; }));
  double noise = 0;  // of both sensors together
  for (const MotionPair& pair : pairs) {
    const double difference = pair.a.real.tail<3>().norm() - pair.b.real.tail<3>().norm();
    noise += 0.5 * pair.eta * difference * difference;
  }
  if (!(moment > 0)) return 0;
  return noise > 0 ? moment / noise : std::numeric_limits<double>::infinity();
}

/// Sine of the angle between two directions of any length; a vanishing one counts as parallel.
double real_sine(const Eigen::Vector4d& u1, const Eigen::Vector4d& u2) {
  Eigen::Matrix<double, 4, 2> U;
  U << u1, u2;
  const Eigen::Vector2d values = Eigen::JacobiSVD<Eigen::Matrix<double, 4, 2>>(U).singularValues();
  return values[0] > 0 ? values[1] / values[0] : 1;
}

}  // namespace

BaselineAnswer solve_analytic(std::span<const MotionPair> pairs, const AnalyticOptions& options) {
  BaselineAnswer answer;
  const std::vector<MotionPair> usable = usable_pairs(pairs);
  if (usable.size() < 2) {
    answer.note = "needs two motion pairs with non-parallel axes";
    return answer;
  }
  const Eigen::JacobiSVD<Matrix8d> svd(stacked_factor(usable), Eigen::ComputeFullV);
  const Vector8d& singular = svd.singularValues();
  const Eigen::Vector4d u1 = svd.matrixV().col(6).head<4>(), v1 = svd.matrixV().col(6).tail<4>();
  const Eigen::Vector4d u2 = svd.matrixV().col(7).head<4>(), v2 = svd.matrixV().col(7).tail<4>();

  // (u, v) = l1 (u1, v1) + l2 (u2, v2) with u.v = 0 and |u| = 1; homogeneous in (l1, l2), so that l2 = 0 is
  // no special case
  const double a = u1.dot(v1), b = 0.5 * (u1.dot(v2) + u2.dot(v1)), c = u2.dot(v2);
  const double discriminant = b * b - a * c;
  const double root = std::sqrt(std::max(0.0, discriminant));
  double best_length = 0;
  DualQuaternion best;
  for (const double sign : {-1.0, 1.0}) {
    // the same ratio l1 : l2 in two ways, of which the longer has lost no digits
    const std::array<Eigen::Vector2d, 2> ways{Eigen::Vector2d(-b + sign * root, a),
                                              Eigen::Vector2d(c, -b - sign * root)};
    const Eigen::Vector2d l = ways[ways[0].norm() >= ways[1].norm() ? 0 : 1].normalized();
    const DualQuaternion q{l[0] * u1 + l[1] * u2, l[0] * v1 + l[1] * v2};
    // of the two solutions one has real part zero: the one that [19] discards
    if (q.real.norm() > best_length) {
      best_length = q.real.norm();
      best = q;
    }
  }
  if (!(best_length > 0) || !best.vec().allFinite()) {
    answer.note = "needs two non-parallel rotation axes: the motions do not turn";
    return answer;
  }
  answer.T_a_b = canonical_sign(normalized(best));

  const double rounding = 1e-12 * singular[0];
  if (!(axis_signal(usable) >= options.least_axis_signal)) {
    answer.note = "needs two non-parallel rotation axes: all turn about the same one, up to the noise";
  } else if (!(singular[6] <= std::max(rounding, options.largest_ratio * singular[5])) ||
             singular[5] <= rounding) {
    answer.note = "needs two singular values near zero: the motions do not single out two";
  } else if (!(real_sine(u1, u2) <= options.largest_real_sine)) {
    answer.note = "the null vectors are no (r, d) and (0, r): too much noise";
  } else if (discriminant < 0) {
    answer.note = "the quadratic for the combination has no real solution";
  } else {
    answer.valid = true;
  }
  return answer;
}

}  // namespace egocal
