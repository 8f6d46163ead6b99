// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/division.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "egocal/statistics/median.hpp"
#include "linear_algebra/small_factor.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "solvers/minimiser.hpp"
#include "statistics/distributions.hpp"

namespace egocal::detail {

Parameters zero_vector(Blocks blocks) {
  return Parameters::Zero(blocks.front().g.size());
}

ParameterMatrix zero_matrix(Blocks blocks) {
  return ParameterMatrix::Zero(blocks.front().g.size(), blocks.front().g.size());
}

ParameterMatrix curvature(Blocks blocks) {
  ParameterMatrix sum = zero_matrix(blocks);
  for (const LinearBlock& block : blocks) sum += block.H;
  return sum;
}

double longest_length(const std::vector<Parameters>& residuals, const ChangeTestOptions& options) {
  std::vector<double> lengths;
  lengths.reserve(residuals.size());
  for (const Parameters& z : residuals) lengths.push_back(z.norm());
  return options.longest_residual * median(std::move(lengths));
}

namespace {

/// Median cost of the blocks of one side at q.
double median_cost(Blocks blocks, Part second, bool of_second, const DualQuaternion& q) {
  const Vector8d v = q.vec();
  std::vector<double> costs;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (second.has(i) == of_second) costs.push_back(v.dot(blocks[i].Q * v));
  return median(std::move(costs));
}

/// Whether the motions of each side fit their own optimum far better than that of the other side, without
/// linearising. Medians: the block in which the mount moved fits neither.
std::array<bool, 2> fit_far_better(Blocks blocks, Part second, const ChangeTestOptions& options) {
  const Mode mode = blocks.front().g.size() == 3 ? Mode::planar : Mode::spatial;
  std::array<Matrix8d, 2> Q{Matrix8d::Zero(), Matrix8d::Zero()};
  for (std::size_t i = 0; i < blocks.size(); ++i) Q[second.has(i) ? 1 : 0] += blocks[i].Q;
  const std::array<DualQuaternion, 2> optima{minimiser(Q[0], mode), minimiser(Q[1], mode)};
  std::array<bool, 2> better{};
  for (std::size_t side = 0; side < 2; ++side) {
    const bool of_second = side == 1;
    const double own = median_cost(blocks, second, of_second, optima[side]),
                 others = median_cost(blocks, second, of_second, optima[1 - side]);
    better[side] = others > 0 && own <= options.own_part * others;
  }
  return better;
}

}  // namespace

Division divide(Blocks blocks, Part second, const ChangeTestOptions& options) {
  Division d;
  d.H1 = d.H2 = zero_matrix(blocks);
  for (std::size_t i = 0; i < blocks.size(); ++i) (second.has(i) ? d.H2 : d.H1) += blocks[i].H;
  d.H = d.H1 + d.H2;
  const SmallFactor before(d.H1 + options.borrowed_curvature * d.H);
  const SmallFactor after(d.H2 + options.borrowed_curvature * d.H);
  for (const LinearBlock& block : blocks) d.gradients.push_back(block.g);
  d.residuals.resize(blocks.size());
  std::array<std::size_t, 2> all{}, shortened{};  // blocks of each side
  for (int pass = 0; pass < 3; ++pass) {
    Parameters g1 = zero_vector(blocks), g2 = g1;
    for (std::size_t i = 0; i < blocks.size(); ++i) (second.has(i) ? g2 : g1) += d.gradients[i];
    d.x1 = -before.solve(g1);
    d.x2 = -after.solve(g2);
    for (std::size_t i = 0; i < blocks.size(); ++i)
      d.residuals[i] = blocks[i].inverse_root * (blocks[i].g + blocks[i].H * (second.has(i) ? d.x2 : d.x1));
    const double limit = longest_length(d.residuals, options);
    all = shortened = {};
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const std::size_t side = second.has(i) ? 1 : 0;
      const double length = d.residuals[i].norm();
      ++all[side];
      if (length > limit) {
        d.residuals[i] *= limit / length;
        ++shortened[side];
      }
      d.gradients[i] = blocks[i].root * d.residuals[i] - blocks[i].H * (side == 1 ? d.x2 : d.x1);
    }
  }
  const auto most_fit = [&](std::size_t side) { return 2 * shortened[side] < all[side]; };
  if (most_fit(0) && most_fit(1)) return d;
  const std::array<bool, 2> better = fit_far_better(blocks, second, options);
  d.fits = (most_fit(0) || better[0]) && (most_fit(1) || better[1]);
  return d;
}

ParameterMatrix whitener(Blocks blocks) {
  ParameterMatrix assumed = zero_matrix(blocks);
  for (const LinearBlock& block : blocks) assumed += block.root * block.root;
  const SymmetricEigen<Eigen::Dynamic> noise = symmetric_eigen<Eigen::Dynamic>(assumed);
  const Parameters inverse = noise.values.cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  return noise.vectors * inverse.asDiagonal() * noise.vectors.transpose();
}

ParameterMatrix residual_covariance(Blocks blocks, const std::vector<Parameters>& residuals,
                                    const ParameterMatrix& whiten) {
  ParameterMatrix found = zero_matrix(blocks);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Parameters e = blocks[i].root * residuals[i];
    found += e * e.transpose();
  }
  const auto n = static_cast<double>(blocks.size());
  const SymmetricEigen<Eigen::Dynamic> eigen =
      symmetric_eigen<Eigen::Dynamic>(n / (n - 2) * whiten * found * whiten);
  const Eigen::VectorXd raised = eigen.values.cwiseMax(eigen.values.mean());
  return eigen.vectors * raised.asDiagonal() * eigen.vectors.transpose();
}

double chance_of(double t2, Eigen::Index parameters, std::size_t blocks, const ChangeTestOptions& options) {
  return hotelling_exceeded(t2, static_cast<double>(parameters),
                            options.freedom * (static_cast<double>(blocks) - 2));
}

ChangeEvidence evidence(Blocks blocks, Part second, const Division& d, const ParameterMatrix& whiten) {
  const SmallFactor whole(d.H);
  const ParameterMatrix from_before = whole.solve(d.H2).transpose();  // H2 inv(H)
  const ParameterMatrix from_after = whole.solve(d.H1).transpose();   // H1 inv(H)
  const ParameterMatrix C = residual_covariance(blocks, d.residuals, whiten);
  ParameterMatrix C1 = zero_matrix(blocks), C2 = C1;
  Parameters g1 = zero_vector(blocks), g2 = g1;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    (second.has(i) ? C2 : C1) += blocks[i].root * C * blocks[i].root;
    (second.has(i) ? g2 : g1) += d.gradients[i];
  }
  ChangeEvidence result;
  result.S = from_after * g2 - from_before * g1;
  result.V = from_before * C1 * from_before.transpose() + from_after * C2 * from_after.transpose();
  const SmallFactor factor(result.V);
  if (factor.positive()) result.t2 = result.S.dot(factor.solve(result.S));
  if (!std::isfinite(result.t2) || !d.fits) result.t2 = 0;
  return result;
}

double correlation_of(const std::vector<Parameters>& residuals, const ChangeTestOptions& options) {
  const std::size_t count = residuals.size();
  const auto n = static_cast<double>(count);
  double square = 0, first = 0, second = 0;
  for (std::size_t i = 0; i < count; ++i) {
    square += residuals[i].squaredNorm();
    if (i >= 1) first += residuals[i].dot(residuals[i - 1]);
    if (i >= 2) second += residuals[i].dot(residuals[i - 2]);
  }
  if (!(square > 0)) return 1;
  // the residuals of either side sum to about zero, which takes 2 / n off
  const double lost = 2 / n, scatter = 1 / std::sqrt(n * static_cast<double>(residuals.front().size()));
  const double r1 = first / square + lost - scatter, r2 = second / square + lost - scatter;
  if (!(r1 > 0)) return 1;
  const double phi = std::clamp(r2 / r1, 0.0, options.longest_memory);
  return 1 + 2 * r1 / (1 - phi);
}

ParameterMatrix covariance_of_change(const Division& d, const ParameterMatrix& V,
                                     const ChangeTestOptions& options) {
  // S = M change with M = H1 inv(H) H2
  const ParameterMatrix M = SmallFactor(d.H).solve(d.H2);
  const ParameterMatrix harmonic = d.H1 * M + options.borrowed_curvature * d.H;
  const SmallFactor inverse(harmonic);
  return inverse.solve(ParameterMatrix(inverse.solve(V).transpose()));
}

}  // namespace egocal::detail
