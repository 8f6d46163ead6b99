// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "egocal/robust/consensus.hpp"
#include "egocal/robust/outlier_proof.hpp"
#include "egocal/robust/robust_statistics.hpp"

namespace egocal {

/// One part of a drive in truncated least squares: it costs min(q'Qq, limit).
struct TruncatedPart {
  Matrix8d Q = Matrix8d::Zero();  ///< weighted, positive semidefinite
  double limit = 0;               ///< > 0, in the unit of q'Qq
};

/// Tuning of prove_outliers(). The study is tests/bench/outlier_proof_study.cpp.
struct OutlierProofOptions {
  /// The costs of two choices differ where they do so by more than this part; less is rounding.
  double tolerance = 1e-9;
  /// Solves of the search through the parts that the leverages leave undecided. 200 take 2 ms.
  std::size_t most_solves = 200;
  /// Step of the distances that are checked, a ratio. A smaller one proves no more than one problem in a
  /// hundred of the study more.
  double distance_step = 1.05;
  ConsensusOptions consensus{};  ///< of the choice that is to be proven
};

/// Whether the minimum over the parts that are no outliers is the global minimum of sum min(q'Q_k q, limit_k)
/// over all extrinsics q and so over all 2^K choices of outliers. A competitor that is as good lies at a
/// distance at which some part changes sides; leverages bound what a change can save (docs/method.md,
/// "Outliers"). Parts that they leave undecided are searched by branch and bound. Rigorous: distances and
/// leverages by Cholesky proofs, minima by the certificate of the dual. Not proven where some outlier would
/// be accepted or some kept part rejected by its own limit. 3-D only. Thread-safe, deterministic.
OutlierProof prove_outliers(std::span<const TruncatedPart> parts, const std::vector<bool>& outlier,
                            const OutlierProofOptions& options = {});

/// The same for parts of a drive, as find_consensus() judges them: at the limits that it sets. problem: mode
/// and balance. Not proven where the choice is not the consensus, or rejects runs for another reason than
/// their residual. Empty where there are too few parts to judge, and in planar mode.
std::optional<OutlierProof> prove_outliers(const Problem& problem, std::span<const Statistics> parts,
                                           const std::vector<bool>& outlier, int overlap = 1,
                                           const OutlierProofOptions& options = {});

/// The same for the outliers among motions of one stride: blocks and single motions.
std::optional<OutlierProof> prove_outliers(const Problem& problem, const RobustStatistics& statistics,
                                           int overlap = 1, const OutlierProofOptions& options = {});

}  // namespace egocal
