// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/variance.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "egocal/solvers/global.hpp"
#include "problem/without_part.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/jackknife.hpp"
#include "uncertainty/takes_off.hpp"

namespace egocal {

using namespace detail;

namespace {

constexpr std::size_t four = FourForms::count;

std::size_t fours(std::size_t count) {
  return (count + four - 1) / four;
}

/// Blocks around the minimiser, by fours; nothing is said of the places behind the last one.
struct Blocks {
  std::vector<double> pairs;  ///< of each
  std::vector<FourForms> forms;
  std::vector<Fours<6>> information;  ///< see Jackknife::leave_out
};

/// The sums of neighbours among the first `count` of four, to two places from `first` on. One that has none
/// stays as it is.
template <std::size_t n>
void join(const Fours<n>& from, std::size_t count, std::size_t first, Fours<n>& to) {
  for (std::size_t row = 0; row < n; ++row) {
    to[row][first] = count > 1 ? from[row][0] + from[row][1] : from[row][0];
    to[row][first + 1] = count > 3 ? from[row][2] + from[row][3] : from[row][2];
  }
}

/// Neighbours joined, two by two.
Blocks doubled(const Blocks& blocks) {
  Blocks result;
  const std::size_t count = blocks.pairs.size();
  result.pairs.reserve((count + 1) / 2);
  for (std::size_t i = 0; i < count; i += 2)
    result.pairs.push_back(i + 1 < count ? blocks.pairs[i] + blocks.pairs[i + 1] : blocks.pairs[i]);
  result.forms.resize(fours(result.pairs.size()));
  result.information.resize(result.forms.size());
  for (std::size_t i = 0; i < blocks.forms.size(); ++i) {
    const std::size_t left = count - four * i, first = i % 2 * 2;
    FourForms& to = result.forms[i / 2];
    join(blocks.forms[i].curvature, left, first, to.curvature);
    join(blocks.forms[i].gradient, left, first, to.gradient);
    join(blocks.information[i], left, first, result.information[i / 2]);
  }
  return result;
}

std::vector<Statistics> doubled(const std::vector<Statistics>& blocks) {
  std::vector<Statistics> result;
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
/// transposed: forms of the blocks with the other triangle, where that is not the same.
void set_information(Blocks& blocks, const std::vector<FourForms>& transposed, const TangentForm& all,
                     const ShownDirections& directions) {
  blocks.information.resize(blocks.forms.size());
  Matrix6d factors = all.curvature;
  if (!factorise(factors, directions.shown)) return;
  Matrix6d inverse = Matrix6d::Zero();  // H^-1 e_i
  inverse.topRows(directions.shown) = directions.basis.transpose().topRows(directions.shown);
  for (int i = 0; i < 6; ++i) {
    Vector6d column = inverse.col(i);
    solve_factorised(factors, column, directions.shown);
    inverse.col(i) = column;
  }
  // x'Hx as the sum over a triangle of H, its entries beside the diagonal twice
  TriangleProducts products;
  for (int j = 0, k = 0; j < 6; ++j)
    for (int i = 0; i <= j; ++i)
      products.col(k++) = (i == j ? 1.0 : 2.0) * inverse.row(i).cwiseProduct(inverse.row(j)).transpose();
  for (std::size_t i = 0; i < blocks.forms.size(); ++i)
    blocks.information[i] = sums_of_products(transposed.empty() ? blocks.forms[i] : transposed[i], products);
}

/// Each leave-one-out minimum by one Newton step from the common one, in the directions that are seen.
Jackknife jackknife_of(const Blocks& blocks, const TangentForm& all, double pairs,
                       const ShownDirections& directions) {
  Jackknife jackknife(pairs);
  Fours<6> steps{};
  for (std::size_t i = 0; i < blocks.pairs.size(); ++i) {
    const FourForms& forms = blocks.forms[i / four];
    const std::size_t k = i % four;
    Vector6d step;
    if (directions.shown == 6) {
      if (k == 0) steps = TangentSpace::newton_steps_without(all, forms);
      step = column(steps, k);
    } else {
      step = directions.basis.lazyProduct(TangentSpace::newton_step(all - forms.form(k), directions.shown));
    }
    jackknife.leave_out(blocks.pairs[i], step, column(blocks.information[i / four], k));
  }
  return jackknife;
}

/// Adds some of four to a sum, one after the other.
void add(const FourForms& forms, std::size_t first, std::size_t count, TangentForm& sum) {
  std::size_t entry = 0;
  for (int j = 0; j < 6; ++j) {
    for (int i = j; i < 6; ++i, ++entry) {
      double total = sum.curvature(i, j);
      for (std::size_t k = first; k < first + count; ++k) total += forms.curvature[entry][k];
      sum.curvature(i, j) = sum.curvature(j, i) = total;
    }
    for (std::size_t k = first; k < first + count; ++k)
      sum.gradient[j] += forms.gradient[static_cast<std::size_t>(j)][k];
  }
}

/// Forms of blocks, by fours. transposed: with the other triangle of their curvatures.
std::vector<FourForms> forms_of(const std::vector<const Statistics*>& blocks, const TangentSpace& space,
                                bool transposed = false) {
  std::vector<FourForms> forms(fours(blocks.size()));
  for (std::size_t i = 0; i < forms.size(); ++i) {
    std::array<const Statistics*, four> of;
    for (std::size_t k = 0; k < four; ++k) of[k] = blocks[std::min(four * i + k, blocks.size() - 1)];
    if (space.starts_with_translations()) {
      forms[i] = space.forms(of);
      continue;
    }
    for (std::size_t k = 0; k < four; ++k) {
      TangentForm form = space.form(*of[k]);
      if (transposed) form.curvature.transposeInPlace();
      forms[i].set(k, form);
    }
  }
  return forms;
}

/// All blocks but those that take off, around the minimiser. sum: of all, in their order.
Blocks blocks_around(const Problem& problem, const ShownDirections& directions, TangentForm& sum) {
  std::vector<const Statistics*> staying, taking_off;
  staying.reserve(problem.blocks.size());
  for (const Statistics& block : problem.blocks) (takes_off(block) ? taking_off : staying).push_back(&block);
  Blocks blocks;
  blocks.pairs.reserve(staying.size());
  for (const Statistics* block : staying) blocks.pairs.push_back(static_cast<double>(block->count));
  blocks.forms = forms_of(staying, directions.space);
  const std::vector<FourForms> others = forms_of(taking_off, directions.space);
  for (std::size_t i = 0, k = 0; i + k < problem.blocks.size();) {
    if (takes_off(problem.blocks[i + k])) {
      add(others[k / four], k % four, 1, sum);
      ++k;
    } else {
      const std::size_t count = others.empty() ? std::min(four, staying.size() - i) : 1;
      add(blocks.forms[i / four], i % four, count, sum);
      i += count;
    }
  }
  set_information(blocks,
                  directions.space.starts_with_translations() ? std::vector<FourForms>()
                                                              : forms_of(staying, directions.space, true),
                  sum, directions);
  return blocks;
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

/// By how many times the variance of a sum of many blocks exceeds that of as many single ones, where errors
/// fade from block to block as the lag-one correlation says (an autoregression of order one).
double of_memory(const Jackknife& single, const ObservabilityOptions& options) {
  const double correlation =
      std::clamp(single.correlation_of_neighbours(options.least_equal_blocks), 0.0, options.most_correlation);
  return (1 + correlation) / (1 - correlation);
}

/// Motions between two blocks are in both, so the curvatures of all blocks are together more than the whole.
/// Each is divided by how many times. What is omitted is then a block's share of what is known, with all of
/// its effect; with twice its share the answer without four blocks of long motions would rest on nothing.
void count_once(Blocks& blocks, const TangentForm& all, int shown) {
  Matrix6d factors = all.curvature;
  if (!factorise(factors, shown)) return;
  TangentForm of_blocks;
  for (std::size_t i = 0; i < blocks.forms.size(); ++i)
    add(blocks.forms[i], 0, std::min(four, blocks.pairs.size() - four * i), of_blocks);
  double times = 0;  // the mean over the directions
  for (int i = 0; i < shown; ++i) {
    Vector6d column = of_blocks.curvature.col(i);
    solve_factorised(factors, column, shown);
    times += column[i] / shown;
  }
  if (!(times > 1)) return;
  for (FourForms& forms : blocks.forms)
    for (auto& entries : forms.curvature)
      for (double& entry : entries) entry /= times;
}

}  // namespace

Vector6d detail::spatial_variance(const Problem& problem, double pairs, const ShownDirections& directions,
                                  ErrorCorrelation errors, const ObservabilityOptions& options) {
  TangentForm sum;
  Blocks blocks = blocks_around(problem, directions, sum);
  if (blocks.pairs.size() < problem.blocks.size()) count_once(blocks, sum, directions.shown);
  const Jackknife single = jackknife_of(blocks, sum, pairs, directions);
  Vector6d variance = single.variance();
  if (looks_at_double_blocks(problem, errors, options)) {
    const Blocks twos = doubled(blocks);
    const Jackknife of_twos = jackknife_of(twos, sum, pairs, directions);
    variance = variance.cwiseMax(of_twos.variance());
    variance *= scatter_of_long_parts(jackknife_of(doubled(twos), sum, pairs, directions),
                                      single.spread().cwiseMax(of_twos.spread()));
    variance = variance.cwiseMax(of_memory(single, options) * single.variance());
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
      const Solution without = solve_planar(cost_matrix(without_part(all, block), problem.balance));
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
