// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/variance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "linear_algebra/symmetric_eigen.hpp"
#include "uncertainty/jackknife.hpp"
#include "uncertainty/takes_off.hpp"

namespace egocal {

using namespace detail;

namespace {

constexpr std::size_t four = FourForms::count;

std::size_t fours(std::size_t count) {
  return (count + four - 1) / four;
}

/// Blocks around the minimiser, by fours; places after the last block are unspecified.
struct Blocks {
  std::vector<double> pairs;  ///< of each
  std::vector<FourForms> forms;
  std::vector<Fours<6>> information;  ///< see Jackknife::leave_out
  Vector6d information_of_all =
      Vector6d::Zero();  ///< in the same units; less than their sum where they touch
};

/// H^-1 e_i as columns; empty where the curvature has none.
std::optional<Matrix6d> inverse_of(const TangentForm& all, const ShownDirections& directions) {
  Matrix6d factors = all.curvature;
  if (!factorise(factors, directions.shown)) return std::nullopt;
  Matrix6d inverse = Matrix6d::Zero();
  inverse.topRows(directions.shown) = directions.basis.transpose().topRows(directions.shown);
  for (int i = 0; i < 6; ++i) {
    Vector6d column = inverse.col(i);
    solve_factorised(factors, column, directions.shown);
    inverse.col(i) = column;
  }
  return inverse;
}

/// The variance of x_i under white noise is e_i'H^-1 e_i, to which a block contributes e_i'H^-1 H_k H^-1 e_i.
/// transposed: forms of the blocks with the other triangle, where that is not the same.
void set_information(Blocks& blocks, const std::vector<FourForms>& transposed, const TangentForm& all,
                     const ShownDirections& directions) {
  blocks.information.resize(blocks.forms.size());
  const std::optional<Matrix6d> found = inverse_of(all, directions);
  if (!found) return;
  const Matrix6d& inverse = *found;
  blocks.information_of_all = directions.basis.lazyProduct(inverse).diagonal();
  // x'Hx as the sum over a triangle of H, its entries beside the diagonal twice
  TriangleProducts products;
  for (int j = 0, k = 0; j < 6; ++j)
    for (int i = 0; i <= j; ++i)
      products.col(k++) = (i == j ? 1.0 : 2.0) * inverse.row(i).cwiseProduct(inverse.row(j)).transpose();
  for (std::size_t i = 0; i < blocks.forms.size(); ++i)
    blocks.information[i] = sums_of_products(transposed.empty() ? blocks.forms[i] : transposed[i], products);
}

/// Parts of a step in the directions that are seen: with the curvature H = LDL' of these directions, L' times
/// the step. Errors of these parts are independent, and of one size up to D, where the noise is what the
/// weights are made for. factors: of factorise().
Vector6d independent_parts(const Matrix6d& factors, const Vector6d& step, int shown) {
  Vector6d parts = Vector6d::Zero();
  for (int j = 0; j < shown; ++j) {
    parts[j] = step[j];
    for (int i = j + 1; i < shown; ++i) parts[j] += factors(i, j) * step[i];
  }
  return parts;
}

/// Each leave-one-out minimum by one Newton step from the common one, in the directions that are seen.
/// take(pairs of the block, difference in a's frame, information, independent parts).
template <typename Take>
void leave_out_each(const Blocks& blocks, const TangentForm& all, const ShownDirections& directions,
                    const Take& take) {
  Matrix6d factors = all.curvature;
  if (!factorise(factors, directions.shown)) factors.setIdentity();
  Fours<6> steps{};
  for (std::size_t i = 0; i < blocks.pairs.size(); ++i) {
    const FourForms& forms = blocks.forms[i / four];
    const std::size_t k = i % four;
    Vector6d step, change;
    if (directions.shown == 6) {
      if (k == 0) steps = TangentSpace::newton_steps_without(all, forms);
      change = step = column(steps, k);
    } else {
      step = TangentSpace::newton_step(all - forms.form(k), directions.shown);
      change = directions.basis.lazyProduct(step);
    }
    take(blocks.pairs[i], change, column(blocks.information[i / four], k),
         independent_parts(factors, step, directions.shown));
  }
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

/// Removes rounding: a coordinate without a part in any shown direction must not count in a mean, or a
/// maximum, over the coordinates.
ShownDirections without_rounding(ShownDirections directions) {
  constexpr double least_part = 1e-6;  // far above rounding; less is not observable
  for (int i = 0; i < 6; ++i)
    if (!(directions.basis.row(i).head(directions.shown).norm() > least_part))
      directions.basis.row(i).setZero();
  return directions;
}

/// Principal axes, as columns, of what white noise makes of the translation and of the rotation. Unlike the
/// axes of a's frame, these turn with it.
struct PrincipalAxes {
  std::array<Eigen::Matrix3d, 2> of_part{Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()};

  PrincipalAxes() = default;
  PrincipalAxes(const TangentForm& all, const ShownDirections& directions) {
    const std::optional<Matrix6d> inverse = inverse_of(all, directions);
    if (!inverse) return;
    const Matrix6d covariance = directions.basis.lazyProduct(*inverse);
    for (const int part : {0, 1}) {
      const Eigen::Matrix3d own = covariance.block<3, 3>(3 * part, 3 * part);
      of_part[static_cast<std::size_t>(part)] = symmetric_eigen<3>(0.5 * (own + own.transpose())).vectors;
    }
  }
  /// Rows of a's axes in these.
  template <typename Rows>
  Rows along(const Rows& given) const {
    Rows turned;
    turned.template topRows<3>() = of_part[0].transpose().lazyProduct(given.template topRows<3>());
    turned.template bottomRows<3>() = of_part[1].transpose().lazyProduct(given.template bottomRows<3>());
    return turned;
  }
  ShownDirections along(ShownDirections directions) const {
    const Matrix6d turned = along(directions.basis);
    directions.basis = turned;
    return without_rounding(directions);
  }
};

/// All blocks except those that are subtracted, around the minimiser. sum: of all, in their order. axes:
/// set to the principal axes, along which the blocks' information is counted; null: along those of a.
Blocks blocks_around(const Problem& problem, const ShownDirections& directions, TangentForm& sum,
                     PrincipalAxes* axes) {
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
  if (axes) *axes = PrincipalAxes(sum, directions);
  set_information(blocks,
                  directions.space.starts_with_translations() ? std::vector<FourForms>()
                                                              : forms_of(staying, directions.space, true),
                  sum, axes ? axes->along(directions) : directions);
  return blocks;
}

/// What blocks that touch share makes their effects correlate even where no error lasts: a motion between two
/// of them is in both, and so are all motions that span a pose or step near their border, with its noise.
/// overlap: by how much the blocks are together more than the whole. Neighbours correlate by three quarters
/// of it where the noise is what the weights are made for. Where nearly all motions are longer than a block
/// (overlap near one) what is shared is spread over many blocks, little between any two. Studies:
/// docs/intervals.md, "What touching blocks share".
struct Sharing {
  /// Correlation of neighbours, as a part of the overlap: 0.75 less what errors that are not random need.
  static constexpr double of_overlap = 0.6;

  explicit Sharing(double overlap) : overlap_(overlap) {
    const double squared = overlap * overlap, fourth = squared * squared, eighth = fourth * fourth;
    longest_ = eighth * eighth;  // from a tenth at 0.87 to one half at 0.96
  }
  /// What neighbours correlate by, and so do near blocks in all.
  double of_neighbours() const { return of_overlap * overlap_ * (1 - longest_); }
  /// Factor of the correlations of near blocks: they show half of what the longest motions cause.
  double near_blocks_count() const { return 1 + longest_; }

 private:
  double overlap_, longest_;
};

/// What a factor of a variance is where its logarithm is itself known with this error, so that 1.96 standard
/// deviations still cover 95 %: a variance of nu degrees of freedom has a logarithm with the variance 2 / nu,
/// and the two add up (Satterthwaite 1946). The factor is not below one, so the error is at most its
/// logarithm. freedom: of the variance; fewer: what the factor leaves of it.
double with_error(double factor, double error, double fewer, double freedom) {
  constexpr double least_freedom = 2;  // below, student_factor() is too small
  const double uncertain = std::clamp(std::log(factor), 0.0, error);
  const double left = 1 / (1 / fewer + 0.5 * uncertain * uncertain);
  const double student = student_factor(std::max(least_freedom, left)) / student_factor(freedom);
  return factor * student * student;
}

/// By how many times the variance of a sum of many blocks exceeds that of as many single ones, where errors
/// fade from block to block as the lag-one correlation r says (an autoregression of order one). Blocks show
/// the variance itself with fewer degrees of freedom, as (1 - r^2) / (1 + r^2) times as many would (Bartlett
/// 1946). error: standard error of r; the logarithm of the factor, 2 atanh(r), has 2 error / (1 - r^2).
double of_fading(double r, double error, double freedom) {
  return with_error((1 + r) / (1 - r), 2 * error / (1 - r * r), freedom * (1 - r * r) / (1 + r * r), freedom);
}

/// The same by the sum of the correlations of near blocks. error: its standard error.
double of_near_blocks(double sum, double error, double freedom) {
  const double factor = 1 + 2 * sum;
  return factor > 1 ? with_error(factor, 2 * error / factor, freedom, freedom) : 1;
}

/// The part of what a direction's own correlation exceeds the mean by that counts; the rest is chance. With
/// 0.5 wandering noise in the plane is covered to half a percent more (20 motions), and white noise has
/// standard deviations that are 1.5 % larger in 25 blocks (docs/intervals.md, "Noise that lasts").
constexpr double part_of_own = 0.3;

/// Factor of the variance of each direction by errors that last: the larger of of_fading() and
/// of_near_blocks(), which sums the correlations of near blocks, as errors need not fade like that. Where
/// blocks touch, most of what single directions and chance show is what the blocks share, so both count only
/// as far as blocks do not touch: measured, not derived (docs/intervals.md, "Noise that lasts").
Vector6d of_memory(const Jackknife& single, double overlap, const ObservabilityOptions& options) {
  const Sharing sharing(overlap);
  const double blocks = single.mean_equal_blocks(options.least_equal_blocks);
  const double most = options.most_correlation;
  const double of_neighbours = sharing.of_neighbours(), disjoint = 1 - overlap;
  const double mean = single.correlation_of_neighbours(of_neighbours, blocks);
  const double error = disjoint * single.error_of_correlation(std::clamp(mean, 0.0, most), blocks);
  const double freedom = single.count() - 1, times = sharing.near_blocks_count();
  const double near_blocks = of_near_blocks(times * (single.sum_of_correlations(blocks) - of_neighbours),
                                            times * single.error_of_sum(blocks), freedom);
  Vector6d factor;
  for (int i = 0; i < 6; ++i) {
    const double own = single.correlation_in_direction(i, of_neighbours, blocks).value_or(mean);
    const double r = std::clamp(mean + part_of_own * disjoint * std::max(0.0, own - mean), 0.0, most);
    factor[i] = std::max(of_fading(r, error, freedom), near_blocks);
  }
  return factor;
}

/// The largest part of the information about a direction that one block holds.
double largest_share(const Blocks& blocks, std::size_t block) {
  const Vector6d own = column(blocks.information[block / four], block % four);
  double share = 0;
  for (int i = 0; i < 6; ++i)
    if (own[i] > 0) share = std::max(share, own[i] / blocks.information_of_all[i]);
  return std::min(share, 1.0);
}

/// Motions between two blocks are in both, so the curvatures of all blocks are together more than the whole.
/// Each is divided by how many times. What is omitted is then a block's share of what is known, with all of
/// its effect; with twice its share the answer without four blocks of long motions would rest on nothing.
/// But a block that holds all that is known of a direction is omitted as a whole: half of it would leave the
/// answer where it is, as if it were certain. Returns by how much the blocks are together more than the
/// whole, from 0 to 1.
double count_once(Blocks& blocks, const TangentForm& all, int shown) {
  Matrix6d factors = all.curvature;
  if (!factorise(factors, shown)) return 0;
  TangentForm of_blocks;
  for (std::size_t i = 0; i < blocks.forms.size(); ++i)
    add(blocks.forms[i], 0, std::min(four, blocks.pairs.size() - four * i), of_blocks);
  double times = 0;  // the mean over the directions
  for (int i = 0; i < shown; ++i) {
    Vector6d along = of_blocks.curvature.col(i);
    solve_factorised(factors, along, shown);
    times += along[i] / shown;
  }
  if (!(times > 1)) return 0;
  for (std::size_t k = 0; k < blocks.pairs.size(); ++k) {
    const double divisor = times - (times - 1) * largest_share(blocks, k);
    for (auto& entries : blocks.forms[k / four].curvature) entries[k % four] /= divisor;
  }
  return std::min(times - 1, 1.0);
}

/// Variances by which settings of one drive are compared, by their sums over the axes: these must not depend
/// on how the axes of a are turned. All axes of the translation have one factor of concentration, and all of
/// the rotation: that of the sum along principal axes.
Vector6d compared_variance(const Problem& problem, double pairs, const ShownDirections& directions,
                           const ObservabilityOptions& options) {
  TangentForm sum;
  PrincipalAxes axes;
  Blocks blocks = blocks_around(problem, directions, sum, &axes);
  if (blocks.pairs.size() < problem.blocks.size()) count_once(blocks, sum, directions.shown);
  VarianceByBlocks in_frame(pairs);
  Jackknife principal(pairs);
  leave_out_each(
      blocks, sum, directions,
      [&](double of_block, const Vector6d& difference, const Vector6d& information, const Vector6d& parts) {
        in_frame.leave_out(of_block, difference);
        principal.leave_out(of_block, axes.along(difference), information, parts);
      });
  const Vector6d factors = principal.concentration(options.least_equal_blocks).cwiseAbs2();
  const Vector6d along = principal.variance();
  Vector6d variance = in_frame.variance();
  for (const int part : {0, 3}) {
    const double all = along.segment<3>(part).sum();
    if (all > 0) variance.segment<3>(part) *= factors.segment<3>(part).dot(along.segment<3>(part)) / all;
  }
  return variance;
}

}  // namespace

Vector6d detail::variance_by_blocks(const Problem& problem, double pairs,
                                    const ShownDirections& all_directions, ErrorCorrelation errors,
                                    const ObservabilityOptions& options) {
  const ShownDirections directions = without_rounding(all_directions);
  if (errors == ErrorCorrelation::independent) return compared_variance(problem, pairs, directions, options);
  TangentForm sum;
  Blocks blocks = blocks_around(problem, directions, sum, nullptr);
  const double overlap =
      blocks.pairs.size() < problem.blocks.size() ? count_once(blocks, sum, directions.shown) : 0;
  Jackknife single(pairs);
  leave_out_each(blocks, sum, directions, [&](const auto&... of_block) { single.leave_out(of_block...); });
  return single.concentration(options.least_equal_blocks)
      .cwiseAbs2()
      .cwiseProduct(single.variance())
      .cwiseProduct(of_memory(single, overlap, options));
}

}  // namespace egocal
