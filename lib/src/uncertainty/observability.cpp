// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/uncertainty/observability.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "egocal/solvers/global.hpp"
#include "egocal/uncertainty/leave_out.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"
#include "uncertainty/hint.hpp"
#include "uncertainty/takes_off.hpp"
#include "uncertainty/tangent_form.hpp"

namespace egocal {

namespace {

using detail::Matrix6d;
using detail::Matrix86d;
using detail::TangentForm;
using detail::TangentSpace;
using detail::Vector6d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Spectrum {
  Matrix6d vectors = Matrix6d::Identity();  ///< columns; dt in units of length, dtheta [rad]
  Vector6d curvatures = Vector6d::Zero();   ///< ascending
};

Spectrum spectrum(const Matrix6d& H) {
  const detail::SymmetricEigen<6> eigen = detail::symmetric_eigen<6>(H);
  return {eigen.vectors, eigen.values};
}

/// Whether all curvatures are larger than that.
bool exceeds(Matrix6d H, double curvature) {
  H.diagonal().array() -= curvature;
  return detail::factorise(H);
}

/// Rotation noise, as it enters D: without noise r'Dr is zero; with noise, independent of sensor and motion,
/// it is added to D in every direction alike.
double rotation_noise(const Matrix8d& Q, const DualQuaternion& q) {
  return std::max(0.0, q.real.dot(Q.bottomRightCorner<4, 4>() * q.real));
}

/// Standard deviations by omitting blocks of unequal length m of n pairs (delete-m_j jack-knife, Busing et
/// al. 1999).
class Jackknife {
 public:
  explicit Jackknife(double pairs) : pairs_(pairs) {}
  /// difference: estimate without the block minus estimate with all. information: what part of what is known
  /// of each direction the block holds, up to a common factor.
  void leave_out(double block_pairs, const Vector6d& difference, const Vector6d& information) {
    const double h = pairs_ / block_pairs;
    const Vector6d pseudo = -(h - 1) * difference;  // pseudo value minus the estimate with all
    count_ += 1;
    sum_ += pseudo / h;
    squares_ += pseudo.cwiseAbs2() / (h - 1);
    cross_ += pseudo / (h - 1);
    weights_ += 1 / (h - 1);
    information_ += information;
    information_squares_ += information.cwiseAbs2();
  }
  /// Mean of (pseudo - mean)^2 / (h - 1).
  Vector6d spread() const {
    return (squares_ - 2 * sum_.cwiseProduct(cross_) + sum_.cwiseAbs2() * weights_) / count_;
  }
  /// With Student's factor: 1.96 of its roots cover 95 % whatever the number of blocks.
  Vector6d variance() const {
    const double student = detail::student_factor(count_ - 1);
    return student * student * spread();
  }
  /// For the standard deviations, where few of the n blocks hold all that is known of a direction (one turn
  /// in the drive): m = (sum of c)^2 / sum of c^2 equal blocks are as concentrated. The factor is Student's
  /// for about m degrees of freedom (Satterthwaite 1946), times the root of (m - 1) / m to (n - 1) / n, the
  /// part by which the jack-knife over m overestimates. One where all blocks hold alike.
  Vector6d concentration(double least_equal_blocks) const {
    Vector6d factor;
    for (int i = 0; i < 6; ++i) {
      const double squares = information_squares_[i];
      const double all = squares > 0 ? information_[i] * information_[i] / squares : count_;
      const double m = std::clamp(all, least_equal_blocks, count_);
      factor[i] = detail::student_factor(m - m / count_) / detail::student_factor(count_ - 1) *
                  std::sqrt((m - 1) / m * count_ / (count_ - 1));
    }
    return factor;
  }

 private:
  double pairs_;
  double count_ = 0, weights_ = 0;
  Vector6d sum_ = Vector6d::Zero(), squares_ = Vector6d::Zero(), cross_ = Vector6d::Zero();
  Vector6d information_ = Vector6d::Zero(), information_squares_ = Vector6d::Zero();
};

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

/// Coordinates in which the first `shown` directions are seen; basis: from them to (dt in units of length,
/// dtheta).
struct ShownDirections {
  TangentSpace space;
  Matrix6d basis;
  int shown;
};

/// The variance of x_i under white noise is e_i'H^-1 e_i, to which a block contributes e_i'H^-1 H_k H^-1 e_i.
void set_information(std::vector<BlockForm>& blocks, const TangentForm& all,
                     const ShownDirections& directions) {
  Matrix6d factors = all.curvature;
  if (!detail::factorise(factors, directions.shown)) return;
  Matrix6d inverse = Matrix6d::Zero();  // H^-1 e_i
  inverse.topRows(directions.shown) = directions.basis.transpose().topRows(directions.shown);
  for (int i = 0; i < 6; ++i) {
    Vector6d column = inverse.col(i);
    detail::solve_factorised(factors, column, directions.shown);
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
  const auto without = [&](const BlockForm& block) {
    TangentForm rest = all;
    rest -= block.form;
    return rest;
  };
  std::size_t i = 0;
  for (; directions.shown == 6 && i + 1 < blocks.size(); i += 2) {
    const auto steps = TangentSpace::newton_steps(without(blocks[i]), without(blocks[i + 1]));
    jackknife.leave_out(blocks[i].pairs, steps[0], blocks[i].information);
    jackknife.leave_out(blocks[i + 1].pairs, steps[1], blocks[i + 1].information);
  }
  for (; i < blocks.size(); ++i) {
    const Vector6d step = TangentSpace::newton_step(without(blocks[i]), directions.shown);
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

/// Per direction the larger of the variances with single and with double blocks, times what longer parts say.
Vector6d spatial_variance(const Problem& problem, double pairs, const ShownDirections& directions,
                          ErrorCorrelation errors, const ObservabilityOptions& options) {
  std::vector<BlockForm> blocks;
  blocks.reserve(problem.blocks.size());
  TangentForm sum;
  const auto take = [&](const Statistics& block, const TangentForm& form) {
    sum += form;
    if (!detail::takes_off(block))
      blocks.push_back({form, static_cast<double>(block.count), Vector6d::Zero()});
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

/// Whether the translation along a direction (dt in units of length, dtheta) differs from zero by more than
/// chance: rotation noise that the sensors share pulls it there where no motion shows it.
bool shown_by_translations(const Vector6d& direction, const Problem& problem, const Matrix8d& Q_metres,
                           const DualQuaternion& T_a_b, double length, double sigmas) {
  const std::vector<Vector6d> differences = leave_out_differences(problem, Q_metres, T_a_b);
  const auto blocks = static_cast<double>(differences.size());
  double mean = 0, squares = 0;
  const auto along = [&](Vector6d difference) {
    difference.head<3>() /= length;
    return direction.dot(difference);
  };
  for (const Vector6d& difference : differences) mean += along(difference) / blocks;
  for (const Vector6d& difference : differences) squares += std::pow(along(difference) - mean, 2);
  const double stddev = std::sqrt(squares * (blocks - 1) / blocks);
  return std::abs(direction.head<3>().dot(to_pose(T_a_b).translation)) / length > sigmas * stddev;
}

Observability spatial_observability(const Problem& problem, const Matrix8d& Q_metres,
                                    const DualQuaternion& T_a_b, ErrorCorrelation errors,
                                    const ObservabilityOptions& options) {
  Observability result;
  result.stddev.fill(infinity);
  double pairs = 0;
  for (const Statistics& block : problem.blocks) pairs += static_cast<double>(block.count);
  const double length = detail::length_scale(Q_metres);
  const Matrix8d Q = detail::in_units_of(length, Q_metres);
  const DualQuaternion q = detail::in_units_of(length, T_a_b);
  const Matrix86d T = detail::frame_a_basis(q);
  const Matrix6d H = T.transpose() * lagrangian_matrix(Q, least_squares_multipliers(Q, q)) * T;

  // What is left of the curvature when noise is taken off: in the translations `independent_noise` times what
  // rotation noise adds to D (a quarter, as d = t r / 2), in the rotations the fluctuation of J, whose mean
  // lambda_1 takes off already.
  const double noise = rotation_noise(Q, q);
  const double fluctuation = 4 / std::sqrt(std::max(1.0, pairs));
  Matrix6d clean = H;
  clean.diagonal().head<3>().array() -= 0.25 * noise * (options.independent_noise + fluctuation);
  clean.diagonal().tail<3>().array() -= 0.25 * fluctuation * std::max(0.0, cost(Q, q));
  const double floor = 1e-12 * (H.diagonal().cwiseAbs().sum() + Q.diagonal().maxCoeff() * 1e-3);
  const bool may_share =
      errors == ErrorCorrelation::correlated && problem.blocks.size() >= options.least_blocks;
  const double doubtful =
      floor + (may_share ? 0.25 * noise * (options.shared_noise - options.independent_noise) : 0);
  // mostly all directions are seen beyond doubt, which a factorisation shows at a tenth of the cost
  const bool all_seen = exceeds(clean, doubtful);
  const Spectrum seen = all_seen ? Spectrum{} : spectrum(clean);
  int hidden = 0;
  if (!all_seen)
    while (hidden < 6 && !(seen.curvatures[hidden] > floor)) ++hidden;
  if (!all_seen && may_share)
    while (hidden < 6 && seen.curvatures[hidden] < doubtful &&
           seen.vectors.col(hidden).head<3>().norm() > options.least_translation_part &&
           !shown_by_translations(seen.vectors.col(hidden), problem, Q_metres, T_a_b, length,
                                  options.shown_sigmas))
      ++hidden;

  const auto hidden_vectors = seen.vectors.leftCols(hidden);
  for (int i = 0; i < 6; ++i)
    result.observable[static_cast<std::size_t>(i)] = hidden_vectors.row(i).norm() <= options.leak;
  int hidden_translations = 0;
  bool rotation_hidden = false;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (int k = 0; k < hidden; ++k) {
    const Vector6d v = seen.vectors.col(k);
    if (v.head<3>().norm() > options.hinted_part) {
      ++hidden_translations;
      direction = v.head<3>().normalized();
    }
    if (v.tail<3>().norm() > options.hinted_part) rotation_hidden = true;
  }
  result.hint = detail::spatial_hint(hidden_translations, rotation_hidden, direction);

  if (hidden == 6 || problem.blocks.size() < options.least_blocks) return result;
  const Matrix6d basis = hidden == 0 ? Matrix6d::Identity() : Matrix6d(seen.vectors.rowwise().reverse());
  const Matrix86d tangent = hidden == 0 ? T : Matrix86d(T.lazyProduct(basis));
  const ShownDirections directions{TangentSpace(q, length, tangent, problem.balance), basis, 6 - hidden};
  const Vector6d variance = spatial_variance(problem, pairs, directions, errors, options);
  // Rotation noise also pulls the translation towards where it costs least, by the part of D that is noise.
  Vector6d pull = Vector6d::Zero();
  const Eigen::Vector3d t = 2 * quaternion_product(q.dual, quaternion_conjugate(q.real)).tail<3>();
  const Eigen::Matrix3d D_t = 4 * H.topLeftCorner<3, 3>();
  const Eigen::LDLT<Eigen::Matrix3d> D_factor(D_t);
  if (D_factor.info() == Eigen::Success && D_factor.isPositive()) pull.head<3>() = noise * D_factor.solve(t);
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!result.observable[k]) continue;
    const double stddev = std::sqrt(variance[i] + pull[i] * pull[i]) * (i < 3 ? length : 1);
    if (std::isfinite(stddev)) result.stddev[k] = stddev;
  }
  return result;
}

/// Per direction the larger of the variances with single and with double blocks, each minimum solved for.
Vector6d planar_variance(const Problem& problem, const Statistics& all, const DualQuaternion& T_a_b,
                         ErrorCorrelation errors, const ObservabilityOptions& options) {
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const auto jackknife_of = [&](const std::vector<Statistics>& blocks) {
    Jackknife jackknife(std::max(1.0, static_cast<double>(all.count)));
    for (const Statistics& block : blocks) {
      Statistics rest = all;
      rest.dual_rows -= block.dual_rows;
      rest.weight -= block.weight;
      const Solution without = solve_planar(cost_matrix(rest, problem.balance));
      jackknife.leave_out(static_cast<double>(block.count),
                          detail::frame_a_difference(T_a_b, extrinsic_from_planar(without.q, G_a, G_b)),
                          Vector6d::Zero());
    }
    return jackknife;
  };
  std::vector<Statistics> blocks;
  for (const Statistics& block : problem.blocks)
    if (!detail::takes_off(block)) blocks.push_back(block);
  const Jackknife single = jackknife_of(blocks);
  Vector6d variance = single.variance();
  if (looks_at_double_blocks(problem, errors, options))
    variance = variance.cwiseMax(jackknife_of(doubled(blocks)).variance());
  return variance;
}

Observability planar_observability(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                   ErrorCorrelation errors, const ObservabilityOptions& options) {
  Observability result;
  result.stddev.fill(infinity);
  const Statistics all = sum_blocks(problem.blocks);
  const DualQuaternion G_a = plane_frame(problem.plane_a), G_b = plane_frame(problem.plane_b);
  const DualQuaternion T_p = planar_from_extrinsic(T_a_b, G_a, G_b);

  // yaw: curvature of the cost minimised over the translation; x, y: the block of D, less what rotation noise
  // makes
  const double count = std::max(1.0, static_cast<double>(all.count));
  const double fluctuation = 4 / std::sqrt(count);
  const double noise = rotation_noise(Q, T_p);
  const double D_least = detail::symmetric_eigen<2>(Q.block<2, 2>(5, 5)).values[0];
  const Solution best = solve_planar(Q);
  DualQuaternion turned = best.q;  // the other eigenvector of the 2 x 2 Schur complement is the worst yaw
  turned.real = {-best.q.real[3], 0, 0, best.q.real[0]};
  double worst = turned.real.dot(Q.topLeftCorner<4, 4>() * turned.real);
  if (Q.block<2, 2>(5, 5).determinant() > 0) {
    Eigen::Vector2d slope = Q.block<4, 2>(0, 5).transpose() * turned.real;
    worst -= slope.dot(Q.block<2, 2>(5, 5).inverse() * slope);
  }
  const double rounding = 1e-12 * (Q.diagonal().sum());
  const bool yaw_seen = worst - best.cost > fluctuation * std::max(0.0, best.cost) + rounding;
  const double unit = detail::length_scale(Q);
  const bool translation_seen =
      D_least > noise * (options.independent_noise + fluctuation) + rounding / (unit * unit) &&
      D_least > 1e-28 * Q(0, 0);

  // The plane's own directions in sensor a's frame; yaw turns about the normal.
  const Eigen::Vector3d normal = problem.plane_a.normal;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    result.observable[k] = translation_seen && std::abs(normal[i]) <= options.leak;
    // a rotation axis is shown by yaw alone where it is the normal
    result.observable[k + 3] = yaw_seen && 1 - std::abs(normal[i]) <= options.leak;
  }
  if (!translation_seen || !yaw_seen)
    result.hint = translation_seen ? "still needed: motion" : "still needed: turns";

  if (problem.blocks.size() < options.least_blocks) return result;
  const Vector6d variance = planar_variance(problem, all, T_a_b, errors, options);
  const double pull = D_least > 0 ? 2 * T_p.dual.norm() * noise / D_least : infinity;
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!result.observable[k]) continue;
    const double stddev = std::sqrt(variance[i] + (i < 3 ? pull * pull : 0));
    if (std::isfinite(stddev)) result.stddev[k] = stddev;
  }
  return result;
}

}  // namespace

Observability assess_observability(const Problem& problem, const Matrix8d& Q, const DualQuaternion& T_a_b,
                                   ErrorCorrelation errors, const ObservabilityOptions& options) {
  if (!Q.allFinite() || !(Q.diagonal().maxCoeff() > 0)) {
    Observability nothing;
    nothing.stddev.fill(infinity);
    nothing.hint = "still needed: motion";
    return nothing;
  }
  return problem.mode == Mode::planar ? planar_observability(problem, Q, T_a_b, errors, options)
                                      : spatial_observability(problem, Q, T_a_b, errors, options);
}

FlatDirections flat_directions(const Matrix8d& Q_metres, const DualQuaternion& T_a_b) {
  FlatDirections flat;
  flat.length = detail::length_scale(Q_metres);
  const Matrix8d Q = detail::in_units_of(flat.length, Q_metres);
  const DualQuaternion q = detail::in_units_of(flat.length, T_a_b);
  const Matrix86d T = detail::frame_a_basis(q);
  const Matrix6d H = T.transpose() * lagrangian_matrix(Q, least_squares_multipliers(Q, q)) * T;
  const Matrix86d absolute = T.cwiseAbs();
  const double size = absolute.cwiseProduct(Q.cwiseAbs().lazyProduct(absolute)).colwise().sum().maxCoeff();
  if (exceeds(H, 64 * epsilon * size)) {
    flat.basis.resize(6, 0);
    return flat;
  }
  const Spectrum all = spectrum(H);
  int count = 0;
  while (count < 6 && !(all.curvatures[count] > 64 * epsilon * size)) ++count;
  flat.basis = all.vectors.leftCols(count);
  return flat;
}

}  // namespace egocal
