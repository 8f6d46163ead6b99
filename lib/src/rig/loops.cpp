// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "rig/loops.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "linear_algebra/symmetric_eigen.hpp"
#include "problem/without_part.hpp"
#include "solvers/minimiser.hpp"
#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

bool is_of_loop(const RigPair& pair, const Loop& loop) {
  const auto is_in = [&](std::size_t sensor) {
    return std::find(loop.sensors.begin(), loop.sensors.end(), sensor) != loop.sensors.end();
  };
  return is_in(pair.a) && is_in(pair.b);
}

/// T_a_b of every pair, in both directions.
class Extrinsics {
 public:
  void set(std::size_t a, std::size_t b, const DualQuaternion& T) {
    T_[{a, b}] = T;
    T_[{b, a}] = conjugate(T);
  }
  bool has(std::size_t a, std::size_t b) const { return T_.contains({a, b}); }
  const DualQuaternion& at(std::size_t a, std::size_t b) const { return T_.at({a, b}); }
  Vector6d misfit(const std::array<std::size_t, 3>& s) const {
    const DualQuaternion round = at(s[0], s[1]) * at(s[1], s[2]) * at(s[2], s[0]);
    return frame_a_difference(DualQuaternion{}, canonical_sign(normalized(round)));
  }

 private:
  std::map<std::pair<std::size_t, std::size_t>, DualQuaternion> T_;
};

}  // namespace

Eigen::Vector3d attenuation(const Statistics& statistics, const DualQuaternion& T_a_b) {
  const QuaternionMatrix R = right_matrix(T_a_b.real);
  const QuaternionMatrix D = R.transpose() * (statistics.dual_rows.bottomRightCorner<4, 4>() * R);
  const Eigen::Matrix3d D_t = D.bottomRightCorner<3, 3>();
  const Eigen::LDLT<Eigen::Matrix3d> factor(D_t);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d pull = std::max(0.0, D(0, 0)) * factor.solve(to_pose(T_a_b).translation);
  return pull.allFinite() ? pull : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

namespace {

/// The squares of the attenuations of the loop's pairs, in the frame of its first sensor.
Matrix6d attenuations(const Loop& loop, const Extrinsics& whole, std::span<const RigPair> pairs,
                      std::span<const TimedPair> timed) {
  Matrix6d sum = Matrix6d::Zero();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!is_of_loop(pairs[i], loop) || pairs[i].problem.mode == Mode::planar) continue;
    Eigen::Vector3d pull = attenuation(timed[i].all, whole.at(pairs[i].a, pairs[i].b));
    if (pairs[i].a != loop.sensors[0]) pull = to_pose(whole.at(loop.sensors[0], pairs[i].a)).rotation * pull;
    sum.topLeftCorner<3, 3>() += pull * pull.transpose();
  }
  return sum;
}

/// The directions of a misfit that its covariance knows, in units of what counts as known.
struct Known {
  std::size_t directions = 0;
  Vector6d units;             ///< [m, rad]
  Eigen::MatrixXd basis;      ///< orthonormal, one column a direction
  Eigen::VectorXd variances;  ///< along them
};

Known known_part(const Matrix6d& C, const RigOptions& options) {
  Known known;
  known.units.head<3>().setConstant(options.known_translation);
  known.units.tail<3>().setConstant(options.known_rotation);
  const Vector6d inverse = known.units.cwiseInverse();
  const Matrix6d in_units = inverse.asDiagonal() * C * inverse.asDiagonal();
  if (!in_units.allFinite()) return known;
  // a translation is turned by what is not known of the rotation
  if (!(symmetric_eigen<3>(in_units.bottomRightCorner<3, 3>()).values[2] <= 1)) return known;
  const SymmetricEigen<6> all = symmetric_eigen<6>(in_units);
  while (known.directions < 6 && all.values[static_cast<Eigen::Index>(known.directions)] <= 1)
    ++known.directions;
  const auto columns = static_cast<Eigen::Index>(known.directions);
  known.basis = all.vectors.leftCols(columns);
  // rounding: variances of perfect motions
  known.variances = all.values.head(columns).cwiseMax(1e-18);
  return known;
}

/// The misfit against its covariance: what it varies by when parts of the drive are omitted in all its pairs
/// together, and what is systematic.
void judge(Loop& loop, const Vector6d& misfit, const std::vector<Vector6d>& without,
           const Matrix6d& systematic, const std::array<double, 2>& stated, const RigOptions& options,
           std::size_t loops) {
  const double count = static_cast<double>(without.size());
  Vector6d mean = Vector6d::Zero();
  for (const Vector6d& m : without) mean += m / count;
  Matrix6d C = systematic;
  for (const Vector6d& m : without) C += (m - mean) * (m - mean).transpose() * ((count - 1) / count);
  // poses are known to a nanometre and a nanoradian at best
  C.diagonal().array() += 1e-18;
  for (int i = 0; i < 6; ++i) {
    loop.misfit[static_cast<std::size_t>(i)] = misfit[i];
    loop.stddev[static_cast<std::size_t>(i)] = std::sqrt(C(i, i));
  }
  const Known known = known_part(C, options);
  loop.known = known.directions;
  if (loop.known == 0) return;
  const Vector6d in_units = known.units.cwiseInverse().cwiseProduct(misfit);
  const Eigen::VectorXd shown = known.basis.transpose() * in_units;
  const double t2 = shown.cwiseAbs2().cwiseQuotient(known.variances).sum();
  loop.chi_square = std::isfinite(t2) ? t2 : 0;
  loop.false_alarm = hotelling_exceeded(loop.chi_square, static_cast<double>(loop.known), count - 1);
  const Vector6d of_known = known.units.cwiseProduct(known.basis * shown);
  const bool large = of_known.head<3>().norm() > std::max(options.least_translation, stated[0]) ||
                     of_known.tail<3>().norm() > std::max(options.least_rotation, stated[1]);
  loop.closed = !large || loop.false_alarm >= options.false_alarms / static_cast<double>(loops);
}

/// What the answers of the loop's pairs state to be uncertain by, added up, which bounds the standard
/// deviation of the loop however their errors depend on each other [m, rad].
std::array<double, 2> stated_of(const Loop& loop, std::span<const RigPair> pairs) {
  std::array<double, 2> sum{};
  for (const RigPair& pair : pairs) {
    if (!pair.stated || !is_of_loop(pair, loop)) continue;
    const Eigen::Map<const Vector6d> stddev(pair.stated->data());
    sum[0] += stddev.head<3>().norm();
    sum[1] += stddev.tail<3>().norm();
  }
  return sum;
}

bool enough_motions(const Loop& loop, std::span<const RigPair> pairs, std::span<const TimedPair> timed,
                    const RigOptions& options) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (is_of_loop(pairs[i], loop) &&
        static_cast<std::size_t>(timed[i].all.count) < options.least_motions * options.blocks)
      return false;
  }
  return true;
}

}  // namespace

std::vector<Loop> loops_of(std::size_t sensors, std::span<const RigPair> pairs,
                           std::span<const TimedPair> timed, const RigOptions& options) {
  Extrinsics whole;
  std::vector<Extrinsics> without(options.blocks);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    whole.set(pairs[i].a, pairs[i].b, extrinsic_of(pairs[i].problem, timed[i].all));
    for (std::size_t k = 0; k < options.blocks; ++k) {
      const Statistics rest = without_part(timed[i].all, timed[i].blocks[k]);
      without[k].set(
          pairs[i].a, pairs[i].b,
          rest.count > 0 ? extrinsic_of(pairs[i].problem, rest) : whole.at(pairs[i].a, pairs[i].b));
    }
  }
  std::vector<Loop> loops;
  for (std::size_t a = 0; a < sensors; ++a)
    for (std::size_t b = a + 1; b < sensors; ++b)
      for (std::size_t c = b + 1; c < sensors; ++c)
        if (whole.has(a, b) && whole.has(b, c) && whole.has(c, a)) loops.push_back({{a, b, c}});
  for (Loop& loop : loops) {
    std::vector<Vector6d> misfits;
    misfits.reserve(without.size());
    for (const Extrinsics& part : without) misfits.push_back(part.misfit(loop.sensors));
    judge(loop, whole.misfit(loop.sensors), misfits, attenuations(loop, whole, pairs, timed),
          stated_of(loop, pairs), options, loops.size());
    if (!enough_motions(loop, pairs, timed, options)) loop.known = 0, loop.closed = true;
  }
  return loops;
}

}  // namespace egocal::detail
