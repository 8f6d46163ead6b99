// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Blocks divided into two sets with an extrinsic each, and the evidence that the extrinsics differ.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "moves/linear_blocks.hpp"

namespace egocal::detail {

using Blocks = std::span<const LinearBlock>;

Parameters zero_vector(Blocks blocks);
ParameterMatrix zero_matrix(Blocks blocks);
ParameterMatrix curvature(Blocks blocks);  ///< of all together

/// Consecutive blocks [from, to) with the second extrinsic; the other blocks have the first one.
struct Part {
  std::size_t from = 0, to = 0;
  bool has(std::size_t block) const { return block >= from && block < to; }
};

/// Both optima, and the residuals around them.
struct Division {
  ParameterMatrix H1, H2, H;          ///< curvature of the first, of the second, of all
  std::vector<Parameters> gradients;  ///< with outlying residuals shortened
  std::vector<Parameters> residuals;  ///< whitened
  Parameters x1, x2;                  ///< optima
  /// Whether each optimum fits its own blocks: most of them, or all of them far better than the other
  /// optimum. If a side shows a direction less than its noise does, its optimum there is arbitrary, and all
  /// its blocks would look like wrong ones that have been shortened.
  bool fits = true;
};
Division divide(Blocks blocks, Part second, const ChangeTestOptions& options);

/// Limit of the length of residuals: longer ones count as if they had this length.
double longest_length(const std::vector<Parameters>& residuals, const ChangeTestOptions& options);

/// Whitens residuals by the sum of the noise of all blocks. The noise of one block is uncertain, and its
/// inverse would be too large on average.
ParameterMatrix whitener(Blocks blocks);

/// Covariance of the whitened residuals, of which two extrinsics were fitted. Eigenvalues below the mean are
/// raised to it: the noise has about the assumed shape, so smaller ones are chance and must not count as a
/// precise direction. whiten: of the same blocks.
ParameterMatrix residual_covariance(Blocks blocks, const std::vector<Parameters>& residuals,
                                    const ParameterMatrix& whiten);

/// Chance of T^2 where nothing changes.
double chance_of(double t2, Eigen::Index parameters, std::size_t blocks, const ChangeTestOptions& options);

/// The evidence: S, the gradient of one side at the common optimum, its variance V, and T^2 = S'V^-1 S.
struct ChangeEvidence {
  Parameters S;
  ParameterMatrix V;
  double t2 = 0;
};
ChangeEvidence evidence(Blocks blocks, Part second, const Division& d, const ParameterMatrix& whiten);

/// How much more sums of neighbouring residuals vary than sums of independent ones, which shows noise that
/// wanders. If noise is forgotten, blocks k apart correlate by r1 phi^(k-1). Long sums then vary by the
/// factor 1 + 2 r1 / (1 - phi). Both correlations are reduced by their standard deviation.
double correlation_of(const std::vector<Parameters>& residuals, const ChangeTestOptions& options);

/// Covariance of the second extrinsic minus the first. V: that of the evidence.
ParameterMatrix covariance_of_change(const Division& d, const ParameterMatrix& V,
                                     const ChangeTestOptions& options);

}  // namespace egocal::detail
