// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/change_test.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "linear_algebra/symmetric_eigen.hpp"
#include "statistics/distributions.hpp"
#include "statistics/median.hpp"

namespace egocal::detail {

namespace {

using Blocks = std::span<const LinearBlock>;

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

/// One division of the blocks: both optima, and the residuals around them.
struct Division {
  ParameterMatrix H1, H2, H;          ///< curvature before, after, in all
  std::vector<Parameters> gradients;  ///< with outlying residuals shortened
  std::vector<Parameters> residuals;  ///< whitened
  Parameters x1, x2;                  ///< optima
};

/// Where the lengths of residuals end: those of blocks that are longer count as if they were this long.
double longest_length(const std::vector<Parameters>& residuals, const ChangeTestOptions& options) {
  std::vector<double> lengths;
  lengths.reserve(residuals.size());
  for (const Parameters& z : residuals) lengths.push_back(z.norm());
  return options.longest_residual * median(std::move(lengths));
}

Division divide(Blocks blocks, std::size_t split, const ChangeTestOptions& options) {
  Division d;
  d.H1 = curvature(blocks.first(split));
  d.H2 = curvature(blocks.subspan(split));
  d.H = d.H1 + d.H2;
  const Eigen::LDLT<ParameterMatrix> before(ParameterMatrix(d.H1 + options.borrowed_curvature * d.H));
  const Eigen::LDLT<ParameterMatrix> after(ParameterMatrix(d.H2 + options.borrowed_curvature * d.H));
  for (const LinearBlock& block : blocks) d.gradients.push_back(block.g);
  d.residuals.resize(blocks.size());
  for (int pass = 0; pass < 3; ++pass) {
    Parameters g1 = zero_vector(blocks), g2 = g1;
    for (std::size_t i = 0; i < blocks.size(); ++i) (i < split ? g1 : g2) += d.gradients[i];
    d.x1 = -before.solve(g1);
    d.x2 = -after.solve(g2);
    for (std::size_t i = 0; i < blocks.size(); ++i)
      d.residuals[i] = blocks[i].inverse_root * (blocks[i].g + blocks[i].H * (i < split ? d.x1 : d.x2));
    const double limit = longest_length(d.residuals, options);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const Parameters& x = i < split ? d.x1 : d.x2;
      const double length = d.residuals[i].norm();
      if (length > limit) d.residuals[i] *= limit / length;
      d.gradients[i] = blocks[i].root * d.residuals[i] - blocks[i].H * x;
    }
  }
  return d;
}

/// What whitens residuals together, by the sum of all blocks' noise: that of one block is uncertain, and its
/// inverse would be too large in the mean.
ParameterMatrix whitener(Blocks blocks) {
  ParameterMatrix assumed = zero_matrix(blocks);
  for (const LinearBlock& block : blocks) assumed += block.root * block.root;
  const SymmetricEigen<Eigen::Dynamic> noise = symmetric_eigen<Eigen::Dynamic>(assumed);
  const Parameters inverse = noise.values.cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  return noise.vectors * inverse.asDiagonal() * noise.vectors.transpose();
}

/// Covariance of the whitened residuals; two extrinsics were fitted. The eigenvalues below their mean are
/// raised to it: the noise has about the shape assumed, so what is smaller is so by chance, and chance must
/// not be taken for a precise direction. whiten: of the same blocks.
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

/// Chance of T^2 where nothing changes.
double chance_of(double t2, Eigen::Index parameters, std::size_t blocks, const ChangeTestOptions& options) {
  return hotelling_exceeded(t2, static_cast<double>(parameters),
                            options.freedom * (static_cast<double>(blocks) - 2));
}

/// The evidence S, what one side's gradients lack to the common optimum, its variance and T^2 = S'V^-1 S.
struct Evidence {
  Parameters S;
  ParameterMatrix V;
  double t2 = 0;
};

Evidence evidence(Blocks blocks, std::size_t split, const Division& d, const ParameterMatrix& whiten) {
  const Eigen::LDLT<ParameterMatrix> whole(d.H);
  const ParameterMatrix from_before = whole.solve(d.H2).transpose();  // H2 inv(H)
  const ParameterMatrix from_after = whole.solve(d.H1).transpose();   // H1 inv(H)
  const ParameterMatrix C = residual_covariance(blocks, d.residuals, whiten);
  ParameterMatrix C1 = zero_matrix(blocks), C2 = C1;
  Parameters g1 = zero_vector(blocks), g2 = g1;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    (i < split ? C1 : C2) += blocks[i].root * C * blocks[i].root;
    (i < split ? g1 : g2) += d.gradients[i];
  }
  Evidence result;
  result.S = from_after * g2 - from_before * g1;
  result.V = from_before * C1 * from_before.transpose() + from_after * C2 * from_after.transpose();
  const Eigen::LDLT<ParameterMatrix> factor(result.V);
  if (factor.info() == Eigen::Success && factor.isPositive())
    result.t2 = result.S.dot(factor.solve(result.S));
  if (!std::isfinite(result.t2)) result.t2 = 0;
  return result;
}

/// How much more the sums of neighbouring residuals vary than those of independent ones would: noise that
/// wanders shows here. Of noise that forgets, the correlation of blocks k apart is r1 phi^(k-1), so the
/// variance of long sums is 1 + 2 r1 / (1 - phi) times that of independent blocks. Both correlations count
/// less their standard deviation.
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

/// Reduction of the cost by an optimum of their own for blocks [from, to).
class Gains {
 public:
  Gains(Blocks blocks, double borrowed) : borrowed_(borrowed) {
    ParameterMatrix H = zero_matrix(blocks);
    Parameters g = zero_vector(blocks);
    H_.push_back(H);
    g_.push_back(g);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      H_.push_back(H += blocks[i].H);
      g_.push_back(g += blocks[i].g);
    }
  }
  double of(std::size_t from, std::size_t to) const {
    const ParameterMatrix H = H_[to] - H_[from] + borrowed_ * H_.back();
    const Parameters g = g_[to] - g_[from];
    return g.dot(H.ldlt().solve(g));
  }

 private:
  double borrowed_;
  std::vector<ParameterMatrix> H_;
  std::vector<Parameters> g_;
};

/// Least squares of an extrinsic that changes evenly over the time, x0 + t v.
struct EvenChange {
  Parameters x0, v;
  Parameters S;                       ///< what shows v
  ParameterMatrix mean;               ///< inv(H) sum t H
  ParameterMatrix slope;              ///< curvature of v, at the best x0
  std::vector<Parameters> residuals;  ///< whitened
  double gain = 0;                    ///< reduction of the cost, of all gradients as they are
};

EvenChange fit_even_change(Blocks blocks, const ParameterMatrix& H, const ChangeTestOptions& options) {
  const ParameterMatrix borrowed = options.borrowed_curvature * H;
  ParameterMatrix Ht = zero_matrix(blocks), Htt = Ht;
  for (const LinearBlock& block : blocks) {
    Ht += block.time * block.H;
    Htt += block.time * block.time * block.H;
  }
  const Eigen::LDLT<ParameterMatrix> whole(ParameterMatrix(H + borrowed));
  EvenChange fit;
  fit.mean = whole.solve(Ht);
  fit.slope = Htt - Ht * fit.mean + borrowed;
  const Eigen::LDLT<ParameterMatrix> slope(fit.slope);
  std::vector<Parameters> gradients;
  for (const LinearBlock& block : blocks) gradients.push_back(block.g);
  for (int pass = 0; pass < 3; ++pass) {
    Parameters g = zero_vector(blocks), gt = g;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      g += gradients[i];
      gt += blocks[i].time * gradients[i];
    }
    fit.S = gt - fit.mean.transpose() * g;
    fit.v = -slope.solve(fit.S);
    fit.x0 = -whole.solve(g) - fit.mean * fit.v;
    if (pass == 0) fit.gain = g.dot(whole.solve(g)) + fit.S.dot(slope.solve(fit.S));
    fit.residuals.clear();
    const auto at = [&](const LinearBlock& block) { return Parameters(fit.x0 + block.time * fit.v); };
    for (const LinearBlock& block : blocks)
      fit.residuals.push_back(block.inverse_root * (block.g + block.H * at(block)));
    const double limit = longest_length(fit.residuals, options);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const double length = fit.residuals[i].norm();
      if (length > limit) fit.residuals[i] *= limit / length;
      gradients[i] = blocks[i].root * fit.residuals[i] - blocks[i].H * at(blocks[i]);
    }
  }
  return fit;
}

/// The same test of v = 0 as of a step.
void test_even_change(Blocks blocks, const EvenChange& fit, const ChangeTestOptions& options,
                      ChangeTest& test) {
  test.begin = fit.x0 - fit.v;
  test.end = fit.x0 + fit.v;
  const ParameterMatrix C = residual_covariance(blocks, fit.residuals, whitener(blocks));
  ParameterMatrix V = zero_matrix(blocks);
  for (const LinearBlock& block : blocks) {
    const ParameterMatrix weight =
        block.time * ParameterMatrix::Identity(C.rows(), C.cols()) - fit.mean.transpose();
    V += weight * (block.root * C * block.root) * weight.transpose();
  }
  const double correlation = correlation_of(fit.residuals, options);
  const Eigen::LDLT<ParameterMatrix> factor(V);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return;
  const double t2 = fit.S.dot(factor.solve(fit.S)) / correlation;
  if (!std::isfinite(t2)) return;
  test.even_false_alarm = chance_of(t2, fit.S.size(), blocks.size(), options);
  const Eigen::LDLT<ParameterMatrix> slope(fit.slope);
  test.even_covariance = 4 * correlation * slope.solve(slope.solve(V).transpose());
}

/// What one unknown reduces the cost by, by chance: from the differences of neighbouring residuals, as those
/// themselves hold what the model does not explain.
double noise_of(const EvenChange& fit) {
  double sum = 0;
  for (std::size_t i = 1; i < fit.residuals.size(); ++i)
    sum += (fit.residuals[i] - fit.residuals[i - 1]).squaredNorm();
  return sum / (2 * static_cast<double>(fit.residuals.size() - 1) * static_cast<double>(fit.S.size()));
}

/// Whether an even change explains more than one division and than the best two, each unknown more of which
/// must gain the logarithm of the number of blocks (the information criterion of Bayes).
bool is_even(Blocks blocks, const EvenChange& fit, std::size_t least_side, const ChangeTestOptions& options) {
  const std::size_t count = blocks.size();
  const double unknown = noise_of(fit) * std::log(static_cast<double>(count));
  const double unknowns_of_a_step = static_cast<double>(fit.S.size()) + 1;
  const Gains gains(blocks, options.borrowed_curvature);
  for (std::size_t i = least_side; i + least_side <= count; ++i) {
    const double before = gains.of(0, i);
    if (fit.gain <= before + gains.of(i, count) - unknown) return false;
    for (std::size_t k = i + least_side; k + least_side <= count; ++k)
      if (fit.gain <= before + gains.of(i, k) + gains.of(k, count) - (unknowns_of_a_step + 1) * unknown)
        return false;
  }
  return true;
}

}  // namespace

ChangeTest test_change(Blocks blocks, std::size_t least_side, const ChangeTestOptions& options) {
  ChangeTest test;
  const std::size_t count = blocks.size();
  if (count < 2 * least_side + 1 || least_side == 0) return test;
  const ParameterMatrix whiten = whitener(blocks);
  double largest = 0;
  for (std::size_t split = least_side; split + least_side <= count; ++split) {
    const double t2 = evidence(blocks, split, divide(blocks, split, options), whiten).t2;
    if (t2 > largest) largest = t2, test.split = split;
  }
  if (test.split == 0) return test;

  const Division d = divide(blocks, test.split, options);
  const Evidence found = evidence(blocks, test.split, d, whiten);
  test.correlation = correlation_of(d.residuals, options);
  const double places = static_cast<double>(count + 1 - 2 * least_side);
  test.false_alarm =
      std::min(1.0, places * chance_of(found.t2 / test.correlation, d.x1.size(), count, options));
  test.change = d.x2 - d.x1;
  // S = M change with M = H1 inv(H) H2
  const ParameterMatrix M = d.H.ldlt().solve(d.H2);
  const ParameterMatrix harmonic = d.H1 * M + options.borrowed_curvature * d.H;
  const Eigen::LDLT<ParameterMatrix> inverse(harmonic);
  test.covariance = test.correlation * inverse.solve(inverse.solve(found.V).transpose());

  const EvenChange even = fit_even_change(blocks, d.H, options);
  test_even_change(blocks, even, options, test);
  test.even = test.even_false_alarm < options.even_looked_at && is_even(blocks, even, least_side, options);
  return test;
}

ChangeAt test_change_at(Blocks blocks, std::size_t split, std::size_t least_side,
                        const ChangeTestOptions& options) {
  ChangeAt best;
  const ParameterMatrix whiten = whitener(blocks);
  for (const std::size_t either : {split, split - std::min<std::size_t>(split, 1)}) {
    const std::size_t at = std::clamp(either, least_side, blocks.size() - least_side);
    const Division d = divide(blocks, at, options);
    const double correlation = correlation_of(d.residuals, options);
    const double t2 = evidence(blocks, at, d, whiten).t2 / correlation;
    const double chance = std::min(1.0, 2 * chance_of(t2, d.x1.size(), blocks.size(), options));
    if (either == split || chance < best.chance) best = {chance, correlation};
  }
  return best;
}

double chance_of_even_change(Blocks blocks, const ChangeTestOptions& options) {
  ChangeTest test;
  test_even_change(blocks, fit_even_change(blocks, curvature(blocks), options), options, test);
  return test.even_false_alarm;
}

}  // namespace egocal::detail
