// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "robust/leverage.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "certificate/assess.hpp"
#include "egocal/solvers/global.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "problem/tangent.hpp"

namespace egocal::detail {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Sums and roots in double are rounded by less than this part.
constexpr double slack = 1e-9;

/// Z of the kept parts with the direction of the answer's rotation made stiff: what is not across it plays no
/// part.
struct Curvature {
  ExtendedSquare<8> Z;                ///< reordered, proven positive semidefinite
  Eigen::Matrix<double, 8, 8> stiff;  ///< Z + stiffness r r', for guesses
  Eigen::Vector4d r;
};

/// The smallest eta that can be proven, near the largest eigenvalue of Q against Z: eta Z + mu rr' - Q >= 0.
double proven_leverage(const Curvature& curvature, const Eigen::LLT<Eigen::Matrix<double, 8, 8>>& factor,
                       const Matrix8d& Q) {
  Eigen::Matrix<double, 8, 8> inner = factor.matrixL().solve(Eigen::Matrix<double, 8, 8>(Q));
  inner = factor.matrixL().solve(Eigen::Matrix<double, 8, 8>(inner.transpose()));
  const double guess = std::max(symmetric_eigenvalues<8>(inner)[7], 1e-12);
  const double mu = 1e4 * (Q.trace() + guess * curvature.stiff.trace());
  for (const double more : {1.01, 1.1, 2.0}) {
    const Extended eta = more * guess;
    ExtendedSquare<8> M;
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = 0; j < 8; ++j) {
        const int row = reordered<8>(i), column = reordered<8>(j);
        M[i][j] = eta * curvature.Z[i][j] - Q(row, column);
        if (row < 4 && column < 4)
          M[i][j] += static_cast<Extended>(mu) * curvature.r[row] * curvature.r[column];
      }
    if (proven_semidefinite<8>(M)) return static_cast<double>(eta) * (1 + slack);
  }
  return infinity;
}

/// The distance Y = y + sqrt(gap) from which on a part may change sides.
double first_change(const PartLeverage& part, bool outlier, double rotation_leverage) {
  const double root = std::sqrt(part.cost), limit = std::sqrt(part.limit), eta = std::sqrt(part.leverage);
  if (!outlier) return (limit - root) / eta * (1 - slack);
  // cos >= 1 - sin^2 and sin^2 <= rotation_leverage Y^2: root (1 - rho Y^2) - eta Y <= limit
  const double rho = rotation_leverage * root, over = root - limit;
  const double Y = rho > 0 ? 2 * over / (eta + std::sqrt(eta * eta + 4 * rho * over)) : over / eta;
  return Y * (1 - slack);
}

/// Parts that may change sides.
struct Candidates {
  std::vector<std::size_t> kept, outliers;

  std::size_t size() const { return kept.size() + outliers.size(); }
};

/// Bound of what a competitor at distance Y can save by rejecting kept parts whose limits cost at most
/// `budget` together: the fractional knapsack.
double most_saved(const LeverageBound& bound, const Candidates& candidates, double Y, double budget,
                  bool with_limits) {
  struct Item {
    double saved, limit;
  };
  std::vector<Item> items;
  for (const std::size_t k : candidates.kept) {
    const PartLeverage& part = bound.parts[k];
    const double root = std::sqrt(part.cost) + std::sqrt(part.leverage) * Y;
    const double saved = root * root * (1 + slack) - (with_limits ? part.limit : 0);
    if (saved > 0) items.push_back({saved, part.limit});
  }
  std::sort(items.begin(), items.end(),
            [](const Item& x, const Item& y) { return x.saved * y.limit > y.saved * x.limit; });
  double saved = 0;
  for (const Item& item : items) {
    const double share = std::min(1.0, budget / item.limit);
    saved += share * item.saved;
    budget -= item.limit;
    if (!(budget > 0)) break;
  }
  return saved * (1 + slack);
}

/// A distance beyond which no competitor is as good; infinite: none is found.
double furthest_competitor(const LeverageBound& bound, const Candidates& candidates, double step) {
  double accepted = 0;  // what accepting outliers can save at most
  for (const std::size_t k : candidates.outliers) accepted += bound.parts[k].limit;
  // a competitor pays for each part that it rejects, and costs at most as much as the answer
  const double budget = (bound.kept_cost + accepted) * (1 + slack);
  const double root_gap = std::sqrt(bound.gap);
  const auto excluded = [&](double low, double high) {
    const double saved = most_saved(bound, candidates, high + root_gap, budget, true);
    return low * low * (1 - slack) > bound.gap + accepted + saved;
  };
  // from `far` on, everything in units of Y^2
  double far = std::max(std::sqrt(budget), root_gap) * 4;
  bool closed = false;
  for (int i = 0; i < 40 && !closed; ++i, far *= 2) {
    const double Y = far + root_gap;
    const double saved = most_saved(bound, candidates, Y, budget, false) / (Y * Y);
    closed = far * far / (Y * Y) * (1 - slack) > saved + (bound.gap + accepted) / (Y * Y) * (1 + slack);
  }
  if (!closed) return infinity;
  double low = far;
  while (low > root_gap && low > 1e-6 * far && excluded(low / step, low)) low /= step;
  return low;
}

}  // namespace

std::optional<LeverageBound> leverage_bound(std::span<const TruncatedPart> parts,
                                            const std::vector<bool>& outlier) {
  Matrix8d Q_metres = Matrix8d::Zero();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!(parts[k].limit > 0) || !parts[k].Q.allFinite()) return std::nullopt;
    if (!outlier[k]) Q_metres += parts[k].Q;
  }
  const double length = length_scale(Q_metres);
  const Matrix8d Q = in_units_of(length, Matrix8d(0.5 * (Q_metres + Q_metres.transpose())));
  const Solution solution = solve_dual(Q);
  if (solution.status != SolverStatus::converged) return std::nullopt;
  const DualQuaternion& q = solution.q;
  const Column<8> v = q.vec();

  LeverageBound result;
  result.kept_cost = std::max(0.0, extended_cost<8>(Q, v));
  const double rounding = rounding_of<8>(sizes_of<8>(Q), v);
  const auto bound = best_bound<8>(Q, result.kept_cost, rounding, solution.lambda.orthogonal, 0);
  if (!bound) return std::nullopt;
  result.gap = std::max(0.0, result.kept_cost - bound->bound) + rounding;
  // the bound less the rounding of Q leaves Z positive definite by it: the sums below are those of the parts
  Curvature curvature;
  curvature.Z = reordered_lagrangian<8>(Q, bound->bound, bound->orthogonal, 0);
  curvature.r = q.real;
  curvature.stiff = lagrangian_matrix(Q, {bound->bound, bound->orthogonal});
  const double stiffness = 1e3 * curvature.stiff.trace();
  curvature.stiff.topLeftCorner<4, 4>() += stiffness * curvature.r * curvature.r.transpose();
  const Eigen::LLT<Eigen::Matrix<double, 8, 8>> factor(curvature.stiff);
  if (factor.info() != Eigen::Success) return std::nullopt;

  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Matrix8d part = in_units_of(length, Matrix8d(0.5 * (parts[k].Q + parts[k].Q.transpose())));
    PartLeverage one;
    one.cost = std::max(0.0, extended_cost<8>(part, v));
    one.limit = parts[k].limit;
    one.leverage = proven_leverage(curvature, factor, part);
    if (!std::isfinite(one.leverage) && !outlier[k]) return std::nullopt;
    result.cost += outlier[k] ? one.limit : one.cost;
    result.parts.push_back(one);
  }
  Matrix8d rotation = Matrix8d::Zero();
  rotation.topLeftCorner<4, 4>() = Eigen::Matrix4d::Identity() - q.real * q.real.transpose();
  result.rotation_leverage = proven_leverage(curvature, factor, rotation);
  return result;
}

std::vector<std::size_t> undecided_parts(const LeverageBound& bound, const std::vector<bool>& outlier,
                                         double distance_step) {
  const double root_gap = std::sqrt(bound.gap);
  Candidates candidates;
  for (std::size_t k = 0; k < outlier.size(); ++k)
    (outlier[k] ? candidates.outliers : candidates.kept).push_back(k);
  while (candidates.size() > 0) {
    const double Y = furthest_competitor(bound, candidates, distance_step) + root_gap;
    const std::size_t before = candidates.size();
    const auto decided = [&](std::size_t k) {
      return first_change(bound.parts[k], outlier[k], bound.rotation_leverage) > Y;
    };
    std::erase_if(candidates.kept, decided);
    std::erase_if(candidates.outliers, decided);
    if (candidates.size() == before) break;
  }
  std::vector<std::size_t> undecided = candidates.kept;
  undecided.insert(undecided.end(), candidates.outliers.begin(), candidates.outliers.end());
  std::sort(undecided.begin(), undecided.end());
  return undecided;
}

}  // namespace egocal::detail
