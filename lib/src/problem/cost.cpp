// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/problem/cost.hpp"

#include <algorithm>

#include "egocal/problem/problem.hpp"

namespace egocal {

Matrix8d pair_cost(const DualQuaternion& a, const DualQuaternion& b, const Vector8d& w) {
  const Matrix8d M = right_matrix(canonical_sign(b)) - left_matrix(canonical_sign(a));
  return M.transpose() * w.asDiagonal() * M;
}

void Statistics::add(const DualQuaternion& a, const DualQuaternion& b, double eta) {
  // The dual rows of Q_b^r - Q_a^l are [E_d E_r] with E = R(b) - L(a) (10), for both signs scalar >= 0.
  const double sa = a.real[0] < 0 ? -1 : 1;
  const double sb = b.real[0] < 0 ? -1 : 1;
  const auto difference = [sa, sb](const Eigen::Vector4d& p, const Eigen::Vector4d& q) -> Eigen::Matrix4d {
    return sb * right_matrix(q) - sa * left_matrix(p);
  };
  const Eigen::Matrix4d E_r = difference(a.real, b.real);
  const Eigen::Matrix4d E_d = difference(a.dual, b.dual);
  Eigen::Matrix4d product = E_d.transpose() * E_d;
  dual_rows.topLeftCorner<4, 4>() += eta * product;
  product.noalias() = E_d.transpose() * E_r;
  dual_rows.topRightCorner<4, 4>() += eta * product;
  dual_rows.bottomLeftCorner<4, 4>() += eta * product.transpose();
  product.noalias() = E_r.transpose() * E_r;
  dual_rows.bottomRightCorner<4, 4>() += eta * product;
  weight += eta;
  ++count;
}

Statistics& Statistics::operator+=(const Statistics& other) {
  dual_rows += other.dual_rows;
  weight += other.weight;
  count += other.count;
  return *this;
}

Matrix8d cost_matrix(const Statistics& statistics, const Balance& balance) {
  if (!(statistics.weight > 0)) return Matrix8d::Zero();
  Matrix8d Q = balance.translation / statistics.weight * statistics.dual_rows;
  Q.topLeftCorner<4, 4>() +=
      balance.rotation / statistics.weight * statistics.dual_rows.bottomRightCorner<4, 4>();
  return Q;
}

BlockStatistics::BlockStatistics(std::vector<Statistics> blocks) : blocks_(std::move(blocks)) {
  if (!blocks_.empty()) pairs_per_block_ = std::max<std::uint64_t>(1, blocks_.front().count);
}

void BlockStatistics::add(const MotionPair& pair) {
  if (blocks_.empty() || blocks_.back().count >= pairs_per_block_) {
    if (blocks_.size() == max_blocks) {
      for (std::size_t i = 0; i < max_blocks / 2; ++i) {
        blocks_[i] = blocks_[2 * i];
        blocks_[i] += blocks_[2 * i + 1];
      }
      blocks_.resize(max_blocks / 2);
      pairs_per_block_ *= 2;
    }
    blocks_.emplace_back();
  }
  blocks_.back().add(pair);
}

Statistics total(const std::vector<Statistics>& blocks) {
  Statistics sum;
  for (const Statistics& block : blocks) sum += block;
  return sum;
}

double cost(const Matrix8d& Q, const DualQuaternion& q) {
  const Vector8d v = q.vec();
  return v.dot(Q * v);
}

Matrix8d cost_matrix(const Problem& problem) {
  return cost_matrix(total(problem.blocks), problem.balance);
}

}  // namespace egocal
