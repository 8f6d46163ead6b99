// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/change_test.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "linear_algebra/small_factor.hpp"
#include "moves/division.hpp"

namespace egocal::detail {

namespace {

/// Reduction of the cost when blocks [from, to) have an optimum of their own.
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
    return g.dot(SmallFactor(H).solve(g));
  }

 private:
  double borrowed_;
  std::vector<ParameterMatrix> H_;
  std::vector<Parameters> g_;
};

/// Least-squares fit of an extrinsic that changes evenly over time, x0 + t v.
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
  const SmallFactor whole(H + borrowed);
  EvenChange fit;
  fit.mean = whole.solve(Ht);
  fit.slope = Htt - Ht * fit.mean + borrowed;
  const SmallFactor slope(fit.slope);
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
  const SmallFactor factor(V);
  if (!factor.positive()) return;
  const double t2 = fit.S.dot(factor.solve(fit.S)) / correlation;
  if (!std::isfinite(t2)) return;
  test.even_false_alarm = chance_of(t2, fit.S.size(), blocks.size(), options);
  const SmallFactor slope(fit.slope);
  test.even_covariance = 4 * correlation * slope.solve(ParameterMatrix(slope.solve(V).transpose()));
}

/// Reduction of the cost by one unknown through chance. It is estimated from differences of neighbouring
/// residuals, as the residuals themselves contain what the model does not explain.
double noise_of(const EvenChange& fit) {
  double sum = 0;
  for (std::size_t i = 1; i < fit.residuals.size(); ++i)
    sum += (fit.residuals[i] - fit.residuals[i - 1]).squaredNorm();
  return sum / (2 * static_cast<double>(fit.residuals.size() - 1) * static_cast<double>(fit.S.size()));
}

/// Whether an even change explains more than one division and more than the best two. Each further unknown
/// must gain the logarithm of the number of blocks (Bayesian information criterion).
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
    const Part after{split, count};
    const double t2 = evidence(blocks, after, divide(blocks, after, options), whiten).t2;
    if (t2 > largest) largest = t2, test.split = split;
  }
  if (test.split == 0) return test;

  const Part after{test.split, count};
  const Division d = divide(blocks, after, options);
  const ChangeEvidence found = evidence(blocks, after, d, whiten);
  test.correlation = correlation_of(d.residuals, options);
  const double places = static_cast<double>(count + 1 - 2 * least_side);
  test.false_alarm =
      std::min(1.0, places * chance_of(found.t2 / test.correlation, d.x1.size(), count, options));
  test.change = d.x2 - d.x1;
  test.covariance = test.correlation * covariance_of_change(d, found.V, options);

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
    const Part after{at, blocks.size()};
    const Division d = divide(blocks, after, options);
    const double correlation = correlation_of(d.residuals, options);
    const double t2 = evidence(blocks, after, d, whiten).t2 / correlation;
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
