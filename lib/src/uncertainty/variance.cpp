// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/variance.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "egocal/solvers/global.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/jackknife.hpp"
#include "uncertainty/takes_off.hpp"

namespace egocal {

using namespace detail;

namespace {

/// A block around the minimiser.
struct BlockForm {
  TangentForm form;
  double pairs = 0;
  Vector6d information = Vector6d::Zero();  ///< see Jackknife::leave_out

  BlockForm& operator+=(const BlockForm& other) {
    form += other.form;
    pairs += other.pairs;
    information += other.information;
    return *this;
  }
};

/// Neighbours joined, two by two.
template <typename Block>
std::vector<Block> doubled(const std::vector<Block>& blocks) {
  std::vector<Block> result;
  result.reserve((blocks.size() + 1) / 2);
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (i % 2 == 0)
      result.push_back(blocks[i]);
    else
      result.back() += blocks[i];
  return result;
}

/// Where neighbours share their errors (noise that wanders) single blocks say too little.
bool looks_at_double_blocks(const Problem& problem, ErrorCorrelation errors,
                            const ObservabilityOptions& options) {
  return errors == ErrorCorrelation::correlated && problem.blocks.size() >= 2 * options.least_double_blocks;
}

/// The variance of x_i under white noise is e_i'H^-1 e_i, to which a block contributes e_i'H^-1 H_k H^-1 e_i.
void set_information(std::vector<BlockForm>& blocks, const TangentForm& all,
                     const ShownDirections& directions) {
  Matrix6d factors = all.curvature;
  if (!factorise(factors, directions.shown)) return;
  Matrix6d inverse = Matrix6d::Zero();  // H^-1 e_i
  inverse.topRows(directions.shown) = directions.basis.transpose().topRows(directions.shown);
  for (int i = 0; i < 6; ++i) {
    Vector6d column = inverse.col(i);
    solve_factorised(factors, column, directions.shown);
    inverse.col(i) = column;
  }
  // x'Hx as the sum over the upper triangle of H, its entries beside the diagonal twice
  Eigen::Matrix<double, 6, 21> products;
  for (int j = 0, k = 0; j < 6; ++j)
    for (int i = 0; i <= j; ++i)
      products.col(k++) = (i == j ? 1.0 : 2.0) * inverse.row(i).cwiseProduct(inverse.row(j)).transpose();
  for (BlockForm& block : blocks) {
    Vector6d information = Vector6d::Zero();
    for (int j = 0, k = 0; j < 6; ++j)
      for (int i = 0; i <= j; ++i) information += block.form.curvature(i, j) * products.col(k++);
    block.information = information.cwiseMax(0.0);
  }
}

/// Each leave-one-out minimum by one Newton step from the common one, in the directions that are seen.
Jackknife jackknife_of(const std::vector<BlockForm>& blocks, const TangentForm& all, double pairs,
                       const ShownDirections& directions) {
  Jackknife jackknife(pairs);
  std::size_t i = 0;
  for (; directions.shown == 6 && i + 1 < blocks.size(); i += 2) {
    const auto steps = TangentSpace::newton_steps_without(all, blocks[i].form, blocks[i + 1].form);
    jackknife.leave_out(blocks[i].pairs, steps[0], blocks[i].information);
    jackknife.leave_out(blocks[i + 1].pairs, steps[1], blocks[i + 1].information);
  }
  for (; i < blocks.size(); ++i) {
    const Vector6d step = TangentSpace::newton_step(all - blocks[i].form, directions.shown);
    const bool as_they_are = directions.shown == 6;
    jackknife.leave_out(blocks[i].pairs, as_they_are ? step : Vector6d(directions.basis.lazyProduct(step)),
                        blocks[i].information);
  }
  return jackknife;
}

/// How much more parts of four blocks scatter than single and double ones say, all directions together: one
/// direction of five or six parts would be mostly chance. Errors that depend on the place, as those of real
/// odometries do, last for longer than a block. One where they do not.
double scatter_of_long_parts(const Jackknife& of_four, const Vector6d& spread) {
  const Vector6d of_parts = of_four.spread();
  double sum = 0, count = 0;
  for (int i = 0; i < 6; ++i) {
    if (!(spread[i] > 0)) continue;
    sum += of_parts[i] / spread[i];
    count += 1;
  }
  return count > 0 ? std::max(1.0, sum / count) : 1;
}

}  // namespace

Vector6d detail::spatial_variance(const Problem& problem, double pairs, const ShownDirections& directions,
                                  ErrorCorrelation errors, const ObservabilityOptions& options) {
  std::vector<BlockForm> blocks;
  blocks.reserve(problem.blocks.size());
  TangentForm sum;
  const auto take = [&](const Statistics& block, const TangentForm& form) {
    sum += form;
    if (!takes_off(block)) blocks.push_back({form, static_cast<double>(block.count), Vector6d::Zero()});
  };
  for (std::size_t i = 0; i < problem.blocks.size(); i += 2) {
    const Statistics& next = problem.blocks[std::min(i + 1, problem.blocks.size() - 1)];
    const std::array<TangentForm, 2> forms = directions.space.forms(problem.blocks[i], next);
    take(problem.blocks[i], forms[0]);
    if (i + 1 < problem.blocks.size()) take(next, forms[1]);
  }
  set_information(blocks, sum, directions);
  const Jackknife single = jackknife_of(blocks, sum, pairs, directions);
  Vector6d variance = single.variance();
  if (looks_at_double_blocks(problem, errors, options)) {
    const std::vector<BlockForm> twos = doubled(blocks);
    const Jackknife of_twos = jackknife_of(twos, sum, pairs, directions);
    variance = variance.cwiseMax(of_twos.variance());
    variance *= scatter_of_long_parts(jackknife_of(doubled(twos), sum, pairs, directions),
                                      single.spread().cwiseMax(of_twos.spread()));
  }
  return single.concentration(options.least_equal_blocks).cwiseAbs2().cwiseProduct(variance);
}

Vector6d detail::planar_variance(const Problem& problem, const Statistics& all, const DualQuaternion& T_a_b,
                                 ErrorCorrelation errors, const ObservabilityOptions& options) {
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const Pose with_all = to_pose(T_a_b);
  const auto jackknife_of = [&](const std::vector<Statistics>& blocks) {
    Jackknife jackknife(std::max(1.0, static_cast<double>(all.count)));
    for (const Statistics& block : blocks) {
      Statistics rest = all;
      rest.dual_rows -= block.dual_rows;
      rest.weight -= block.weight;
      const Solution without = solve_planar(cost_matrix(rest, problem.balance));
      jackknife.leave_out(static_cast<double>(block.count),
                          frame_a_difference(with_all, extrinsic_from_planar(without.q, G_a, G_b)),
                          Vector6d::Zero());
    }
    return jackknife;
  };
  std::vector<Statistics> blocks;
  for (const Statistics& block : problem.blocks)
    if (!takes_off(block)) blocks.push_back(block);
  const Jackknife single = jackknife_of(blocks);
  Vector6d variance = single.variance();
  if (looks_at_double_blocks(problem, errors, options))
    variance = variance.cwiseMax(jackknife_of(doubled(blocks)).variance());
  return variance;
}

}  // namespace egocal
