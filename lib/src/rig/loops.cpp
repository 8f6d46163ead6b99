// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "rig/loops.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "solvers/minimiser.hpp"
#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

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

/// How far noisy rotations pull a translation towards zero, r'Dr inv(D) t (docs/method.md): pairs whose
/// sensors have unlike noise are pulled unlike far, and a loop does not close by that. Sensor a's frame [m].
Eigen::Vector3d attenuation(const Statistics& statistics, const DualQuaternion& T_a_b) {
  const QuaternionMatrix R = right_matrix(T_a_b.real);
  const QuaternionMatrix D = R.transpose() * (statistics.dual_rows.bottomRightCorner<4, 4>() * R);
  const Eigen::Matrix3d D_t = D.bottomRightCorner<3, 3>();
  const Eigen::LDLT<Eigen::Matrix3d> factor(D_t);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d pull = std::max(0.0, D(0, 0)) * factor.solve(to_pose(T_a_b).translation);
  return pull.allFinite() ? pull : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// The squares of the attenuations of the loop's pairs, in the frame of its first sensor.
Matrix6d attenuations(const Loop& loop, const Extrinsics& whole, std::span<const RigPair> pairs,
                      std::span<const TimedPair> timed) {
  Matrix6d sum = Matrix6d::Zero();
  const std::array<std::size_t, 3>& s = loop.sensors;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto in_loop = [&](std::size_t k) { return std::find(s.begin(), s.end(), k) != s.end(); };
    if (!in_loop(pairs[i].a) || !in_loop(pairs[i].b) || pairs[i].problem.mode == Mode::planar) continue;
    Eigen::Vector3d pull = attenuation(timed[i].all, whole.at(pairs[i].a, pairs[i].b));
    if (pairs[i].a != s[0]) pull = to_pose(whole.at(s[0], pairs[i].a)).rotation * pull;
    sum.topLeftCorner<3, 3>() += pull * pull.transpose();
  }
  return sum;
}

/// The misfit against its covariance: what it varies by when parts of the drive are omitted in all its pairs
/// together, and what is systematic.
void judge(Loop& loop, const Vector6d& misfit, const std::vector<Vector6d>& without,
           const Matrix6d& systematic, const RigOptions& options, std::size_t loops) {
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
  const double t2 = misfit.dot(C.ldlt().solve(misfit));
  loop.chi_square = std::isfinite(t2) ? t2 : 0;
  loop.false_alarm = hotelling_exceeded(loop.chi_square, 6, count - 1);
  const bool large =
      misfit.head<3>().norm() > options.least_translation || misfit.tail<3>().norm() > options.least_rotation;
  loop.closed = !large || loop.false_alarm >= options.false_alarms / static_cast<double>(loops);
}

}  // namespace

std::vector<Loop> loops_of(std::size_t sensors, std::span<const RigPair> pairs,
                           std::span<const TimedPair> timed, const RigOptions& options) {
  Extrinsics whole;
  std::vector<Extrinsics> without(options.blocks);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    whole.set(pairs[i].a, pairs[i].b, extrinsic_of(pairs[i].problem, timed[i].all));
    for (std::size_t k = 0; k < options.blocks; ++k) {
      Statistics rest = timed[i].all;
      rest.dual_rows -= timed[i].blocks[k].dual_rows;
      rest.weight -= timed[i].blocks[k].weight;
      rest.count -= timed[i].blocks[k].count;
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
    judge(loop, whole.misfit(loop.sensors), misfits, attenuations(loop, whole, pairs, timed), options,
          loops.size());
  }
  return loops;
}

}  // namespace egocal::detail
