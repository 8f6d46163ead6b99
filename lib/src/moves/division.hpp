// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Blocks divided in two sets with an extrinsic each, and what shows that these differ.
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

/// Consecutive blocks [from, to), which have the second extrinsic. The others have the first one.
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
  /// Whether each optimum fits its own blocks: most of them, or all far better than the other one does. Where
  /// a side shows some direction less than its noise does, its optimum there is anything: all its blocks
  /// would then be wrong ones that have been shortened.
  bool fits = true;
};
Division divide(Blocks blocks, Part second, const ChangeTestOptions& options);

/// Where the lengths of residuals end: those of blocks that are longer count as if they were this long.
double longest_length(const std::vector<Parameters>& residuals, const ChangeTestOptions& options);

/// What whitens residuals together, by the sum of all blocks' noise: that of one block is uncertain, and its
/// inverse would be too large in the mean.
ParameterMatrix whitener(Blocks blocks);

/// Covariance of the whitened residuals; two extrinsics were fitted. The eigenvalues below their mean are
/// raised to it: the noise has about the shape assumed, so what is smaller is so by chance, and chance must
/// not be taken for a precise direction. whiten: of the same blocks.
ParameterMatrix residual_covariance(Blocks blocks, const std::vector<Parameters>& residuals,
                                    const ParameterMatrix& whiten);

/// Chance of T^2 where nothing changes.
double chance_of(double t2, Eigen::Index parameters, std::size_t blocks, const ChangeTestOptions& options);

/// The evidence S, what one side's gradients lack to the common optimum, its variance and T^2 = S'V^-1 S.
struct Evidence {
  Parameters S;
  ParameterMatrix V;
  double t2 = 0;
};
Evidence evidence(Blocks blocks, Part second, const Division& d, const ParameterMatrix& whiten);

/// How much more the sums of neighbouring residuals vary than those of independent ones would: noise that
/// wanders shows here. Of noise that forgets, the correlation of blocks k apart is r1 phi^(k-1), so the
/// variance of long sums is 1 + 2 r1 / (1 - phi) times that of independent blocks. Both correlations count
/// less their standard deviation.
double correlation_of(const std::vector<Parameters>& residuals, const ChangeTestOptions& options);

/// Of the second extrinsic minus the first. V: of the evidence.
ParameterMatrix covariance_of_change(const Division& d, const ParameterMatrix& V,
                                     const ChangeTestOptions& options);

}  // namespace egocal::detail
