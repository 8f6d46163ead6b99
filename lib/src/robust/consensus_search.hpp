// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "egocal/robust/consensus.hpp"

namespace egocal::detail {

/// The parts of a drive, how they fit candidates, and which of them agree with one.
class ConsensusSearch {
 public:
  /// An extrinsic that parts of the drive may agree on.
  struct Candidate {
    DualQuaternion q;
    std::vector<double> residuals;  ///< mean squared, per part
  };

  /// statistics: of each part. overlap: motions that share a pose.
  ConsensusSearch(const Problem& problem, std::span<const Statistics> statistics, int overlap,
                  const ConsensusOptions& options);

  /// The motion of all parts [weight times squared size, which is limited for a part].
  double motion() const { return all_; }

  Candidate fit(const std::vector<double>& factors) const;

  /// Scale of the residuals by medians over the motion, not over time: a vehicle may be at rest for most of
  /// it.
  ResidualScale scale_of(const Candidate& fit) const;
  /// Whether each number of scale_of() is at least that of `than`, for certain; false says nothing. It sums
  /// twice, where scale_of() sorts twice.
  bool is_no_tighter(const Candidate& fit, const ResidualScale& than) const;

  double excess_of(const Candidate& fit, std::size_t i, const ResidualScale& scale) const;
  double largest_excess(const Candidate& fit, const ResidualScale& scale) const;

  double truncated_cost(const Candidate& fit, const ResidualScale& scale) const;

  std::vector<double> agreeing(const Candidate& fit, const ResidualScale& scale) const;

  double motion_of(const std::vector<double>& factors) const;

  /// Solves over what agrees, until the same parts agree again.
  Candidate settled(Candidate fit, const ResidualScale& scale) const;

  /// Graduated non-convexity (Yang et al. 2020) for the Geman-McClure loss: from the convex problem, all
  /// parts counting, to the sharp one.
  Candidate graduated(Candidate fit, const ResidualScale& scale) const;

  Consensus consensus(Candidate fit, const ResidualScale& scale, std::vector<double> factors) const;

  std::size_t size() const { return parts_.size(); }

 private:
  struct Part {
    Matrix8d Q;     ///< (16) of this part alone
    double weight;  ///< of its motions
    double count;
    double size;        ///< squared_size
    double limit;       ///< of the excess over typical
    double motion = 0;  ///< its share in what must agree [weight times squared size]
  };

  /// The squared size at or below which half of the way is made. Lengths and not squares, most of which
  /// belong to few wrong motions.
  double typical_size() const;

  DualQuaternion minimiser(const Matrix8d& Q) const;

  /// A run of motions with the extrinsic that suits it best.
  struct Alone {
    double residual = 0;  ///< mean squared
    double noise = 0;     ///< at least what is typical: a short run may fit by chance
  };

  bool is_run(const Part& part) const { return part.count >= options_.least_run * overlap_ && part.size > 0; }

  std::vector<Alone> fit_alone() const;

  /// The run that stands out among those that count. The gain is about that of six parameters fitted to
  /// noise: six times the noise of one motion, more if motions overlap.
  std::optional<std::size_t> dissenter(const Candidate& fit, const std::vector<Alone>& alone,
                                       const std::vector<double>& factors) const;

  /// Drops the run that would gain most by an extrinsic of its own, again and again, as long as its gain is
  /// far above the others and a majority stays.
  Candidate without_dissenters(Candidate fit, std::vector<double>& factors) const;

  const ConsensusOptions& options_;
  Mode mode_;
  int overlap_;
  std::vector<Part> parts_;
  double all_ = 0;
};

}  // namespace egocal::detail
