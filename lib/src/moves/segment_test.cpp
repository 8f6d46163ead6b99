// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "moves/segment_test.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "linear_algebra/small_factor.hpp"

namespace egocal::detail {

namespace {

/// T^2 of any part of the blocks, up to a common factor, from prefix sums, with the stated noise of the
/// blocks and around the common optimum.
class Scan {
 public:
  Scan(Blocks blocks, const ChangeTestOptions& options) {
    // in coordinates in which the curvature of all is the identity
    const Eigen::LLT<ParameterMatrix> whole(
        ParameterMatrix((1 + options.borrowed_curvature) * curvature(blocks)));
    const auto L = whole.matrixL();
    const auto within = [&](const ParameterMatrix& M) {
      return ParameterMatrix(L.solve(ParameterMatrix(L.solve(M).transpose())));
    };
    std::vector<Parameters> residuals;
    residuals.reserve(blocks.size());
    for (const LinearBlock& block : blocks) residuals.push_back(block.inverse_root * block.g);
    const double limit = longest_length(residuals, options);
    Sums sums{zero_matrix(blocks), zero_matrix(blocks), zero_vector(blocks)};
    sums_.reserve(blocks.size() + 1);
    sums_.push_back(sums);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const double length = residuals[i].norm();
      const double shortened = length > limit ? limit / length : 1;
      sums.H += within(blocks[i].H);
      sums.noise += within(blocks[i].root * blocks[i].root);
      sums.g += L.solve(Parameters(shortened * blocks[i].g));
      sums_.push_back(sums);
    }
  }

  double t2(Part part) const {
    const Sums &to = sums_[part.to], &from = sums_[part.from], &all = sums_.back();
    const ParameterMatrix H = to.H - from.H, noise = to.noise - from.noise, H_rest = all.H - H;
    const Parameters S = to.g - from.g - H * all.g;
    const Eigen::LLT<ParameterMatrix> V(
        ParameterMatrix(H_rest * noise * H_rest + H * (all.noise - noise) * H));
    return V.info() == Eigen::Success ? V.matrixL().solve(S).squaredNorm() : 0;
  }

 private:
  struct Sums {
    ParameterMatrix H, noise;
    Parameters g;
  };
  std::vector<Sums> sums_;
};

/// The part with the largest T^2: parts that end at a few places are tried first, then moved block by block.
Part best_part(Blocks blocks, std::size_t least_side, std::size_t least_part,
               const ChangeTestOptions& options) {
  const Scan scan(blocks, options);
  const std::size_t end = blocks.size() - least_side;
  Part best;
  double largest = 0;
  const auto try_part = [&](std::size_t from, std::size_t to) {
    if (from < least_side || to > end || to < from + least_part) return;
    const double t2 = scan.t2({from, to});
    if (t2 > largest) largest = t2, best = {from, to};
  };
  const std::size_t step = std::max<std::size_t>(1, blocks.size() / options.ends_looked_at);
  for (std::size_t from = least_side; from < end; from += step)
    for (std::size_t to = from + least_part; to <= end; to += step) try_part(from, to);
  for (Part at{0, 0}; best.to > 0 && (at.from != best.from || at.to != best.to);) {
    at = best;
    for (const std::size_t from : {at.from - 1, at.from, at.from + 1})
      for (const std::size_t to : {at.to - 1, at.to, at.to + 1}) try_part(from, to);
  }
  return best;
}

/// The blocks but for a part of them.
std::vector<LinearBlock> without(Blocks blocks, Part part) {
  std::vector<LinearBlock> others;
  others.reserve(blocks.size() - (part.to - part.from));
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (!part.has(i)) others.push_back(blocks[i]);
  return others;
}

/// Chance of the evidence that the part differs from the others, at this place. change: of the part against
/// the others.
double chance_at(Blocks blocks, Part part, const ChangeTestOptions& options, Parameters& change) {
  const Division d = divide(blocks, part, options);
  change = d.x2 - d.x1;
  const double t2 = evidence(blocks, part, d, whitener(blocks)).t2 / correlation_of(d.residuals, options);
  return chance_of(t2, change.size(), blocks.size(), options);
}

double squared_length(const Parameters& change, const ParameterMatrix& covariance) {
  return change.dot(SmallFactor(covariance).solve(change));
}

}  // namespace

SegmentTest test_segment(Blocks blocks, std::size_t least_side, std::size_t least_part,
                         const ChangeTestOptions& options) {
  SegmentTest test;
  const std::size_t count = blocks.size();
  if (least_side == 0 || least_part < 2 || count < 2 * least_side + least_part) return test;
  test.part = best_part(blocks, least_side, least_part, options);
  if (test.part.to == 0) return test;

  const Division d = divide(blocks, test.part, options);
  const ChangeEvidence found = evidence(blocks, test.part, d, whitener(blocks));
  test.correlation = correlation_of(d.residuals, options);
  const auto lengths = static_cast<double>(count - 2 * least_side - least_part + 1);
  const double parts = lengths * (lengths + 1) / 2;
  test.chance = std::min(1.0, parts * chance_of(found.t2 / test.correlation, d.x1.size(), count, options));
  test.change = d.x2 - d.x1;
  test.covariance = test.correlation * covariance_of_change(d, found.V, options);

  const auto [from, to] = test.part;
  const std::size_t middle = (from + to) / 2;
  Parameters change;
  test.chance_of_halves =
      std::max(chance_at(without(blocks, {middle, to}), {from, middle}, options, change),
               chance_at(without(blocks, {from, middle}), {from, from + (to - middle)}, options, change));
  const std::vector<LinearBlock> rest = without(blocks, test.part);
  test.chance_of_rest = chance_at(rest, {from, rest.size()}, options, change);
  const double length = squared_length(test.change, test.covariance);
  test.rest_by_change = length > 0 ? std::sqrt(squared_length(change, test.covariance) / length) : 0;
  return test;
}

}  // namespace egocal::detail
