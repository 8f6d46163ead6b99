// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/problem/cost.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "egocal/problem/problem.hpp"
#include "problem/motion_square.hpp"

namespace egocal {

Matrix8d pair_cost(const DualQuaternion& a, const DualQuaternion& b, const Vector8d& w) {
  const Matrix8d M = right_matrix(canonical_sign(b)) - left_matrix(canonical_sign(a));
  return M.transpose() * w.asDiagonal() * M;
}

namespace {

using detail::QuaternionDifference;

namespace single {
using Number = double;
#include "problem/square_numbers.hpp"
}  // namespace single

single::Difference plain(const QuaternionDifference& e) {
  return {e.s, {e.u[0], e.u[1], e.u[2]}, {e.w[0], e.w[1], e.w[2]}};
}

void set_numbers(const DualQuaternion& a, const DualQuaternion& b, double* to) {
  // The dual rows of Q_b^r - Q_a^l are [E_d E_r] (10), for both signs scalar >= 0.
  const double sa = detail::positive_sign(a), sb = detail::positive_sign(b);
  const QuaternionDifference real(a.real, sa, b.real, sb), dual(a.dual, sa, b.dual, sb);
  single::set_all(plain(dual), plain(real), to);
}

/// Adds eta times number k to its place and to the mirrored one.
template <std::size_t... k>
[[gnu::always_inline]] inline void add_numbers(double* sum, const double* numbers, double eta,
                                               std::index_sequence<k...>) {
  const auto add = [sum](int i, int j, double value) {
    const double total = sum[8 * j + i] + value;
    sum[8 * j + i] = total;
    sum[8 * i + j] = total;
  };
  (add(detail::square_places[k][0], detail::square_places[k][1], eta * numbers[k]), ...);
}

}  // namespace

detail::MotionSquare::MotionSquare(const DualQuaternion& a, const DualQuaternion& b) {
  std::array<double, square_places.size()> numbers;
  set_numbers(a, b, numbers.data());
  for (std::size_t k = 0; k < square_places.size(); ++k) {
    const auto [i, j] = square_places[k];
    entries_[static_cast<std::size_t>(8 * j + i)] = entries_[static_cast<std::size_t>(8 * i + j)] =
        numbers[k];
  }
}

void Statistics::add(const DualQuaternion& a, const DualQuaternion& b, double eta) {
  std::array<double, detail::square_places.size()> numbers;
  set_numbers(a, b, numbers.data());
  add_numbers(dual_rows.data(), numbers.data(), eta,
              std::make_index_sequence<detail::square_places.size()>());
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

Statistics sum_blocks(const std::vector<Statistics>& blocks) {
  Statistics sum;
  // two columns at a time stay in registers over all blocks
  using Columns = Eigen::Matrix<double, 8, 2>;
  for (int first = 0; first < 8; first += 2) {
    Columns columns = Columns::Zero();
    for (const Statistics& block : blocks) columns += block.dual_rows.middleCols<2>(first);
    sum.dual_rows.middleCols<2>(first) = columns;
  }
  for (const Statistics& block : blocks) {
    sum.weight += block.weight;
    sum.count += block.count;
  }
  return sum;
}

double cost(const Matrix8d& Q, const DualQuaternion& q) {
  const Vector8d v = q.vec();
  return v.dot(Q.lazyProduct(v));
}

Matrix8d cost_matrix(const Problem& problem) {
  return cost_matrix(sum_blocks(problem.blocks), problem.balance);
}

}  // namespace egocal
