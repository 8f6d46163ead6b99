// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/single_stride_rival.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/misfit.hpp"
#include "linear_algebra/symmetric_eigen.hpp"
#include "solvers/minimiser.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// Whether a difference is at most this many standard deviations, and rounding, in each principal direction
/// of its covariance. Unlike the axes of a's frame, these turn with it.
bool within(const Eigen::Vector3d& difference, const Eigen::Matrix3d& covariance, double sigmas,
            double rounding) {
  const SymmetricEigen<3> principal = symmetric_eigen<3>(covariance);
  for (int i = 0; i < 3; ++i) {
    const double stddev = std::sqrt(std::max(0.0, principal.values[i]));
    if (std::abs(principal.vectors.col(i).dot(difference)) > sigmas * stddev + rounding) return false;
  }
  return true;
}

/// Whether the sum's answer is where motions of one stride, judged one by one,
/// allow it to be. shorter: the sum's motions are shorter than those.
bool agree(const SpreadByPoses& sum, const SpreadByPoses& single, bool shorter, const SeenDirections& seen,
           const WeightingOptions& options) {
  Vector6d difference = frame_a_difference(single.T_a_b, sum.T_a_b);
  for (std::size_t i = 0; i < 6; ++i)
    if (!seen[i]) difference[static_cast<Eigen::Index>(i)] = 0;
  for (const bool rotation : {false, true}) {
    const int first = rotation ? 3 : 0;
    const Eigen::Vector3d part = difference.segment<3>(first);
    const double rounding =
        rotation ? options.residuals.least_rotation_spread : options.residuals.least_translation_spread;
    const double spread = rotation ? single.rotation : single.translation;
    if (part.norm() > options.agreement * spread + rounding) return false;
    const Eigen::Matrix3d covariance = single.covariance.block<3, 3>(first, first);
    if (shorter && !within(part, covariance, options.contradicts, rounding)) return false;
  }
  return true;
}

/// Whether the spread is that of rounding alone: nothing is to be gained.
bool is_rounding(const SpreadByPoses& spread, const WeightingOptions& options) {
  return spread.rotation < options.residuals.least_rotation_spread &&
         spread.translation < options.residuals.least_translation_spread;
}

/// The part of the neighbouring steps' weight that was taken off as their
/// residuals are far from typical.
double weight_taken_off(const StrideLadder& ladder) {
  const Statistics& steps = ladder.sums.front().motions;
  return steps.count > 0 ? 1 - steps.weight / static_cast<double>(steps.count) : 0;
}

/// Whether motions of the rival are missing in the sum of its stride, or count by rotation alone there: they
/// span jumps.
bool has_jumps(const StrideLadder& ladder, std::size_t place, const Statistics& rival) {
  return ladder.sums[place].motions.count < rival.count;
}

}  // namespace

SingleStrideRival::SingleStrideRival(const SingleStride& rival, const WeightingOptions& options)
    : rival_(rival), options_(options), sum_(sum_blocks(rival.problem.blocks)) {
  if (sum_.weight > 0) own_misfit_ = misfit_of(minimiser(cost_matrix(rival.problem), rival.problem.mode));
}

bool SingleStrideRival::is_refuted_by(const DualQuaternion& q) const {
  return own_misfit_ - misfit_of(q) > std::log(options_.less_likely);
}

bool SingleStrideRival::refutes(const DualQuaternion& q) const {
  return misfit_of(q) - own_misfit_ > std::log(options_.less_likely);
}

double SingleStrideRival::misfit_of(const DualQuaternion& q) const {
  return misfit(sum_, q, options_.residuals.least_rotation_spread,
                options_.residuals.least_translation_spread);
}

std::optional<std::size_t> SingleStrideRival::place_in(const StrideLadder& ladder) const {
  const auto place = std::find(ladder.strides.begin(), ladder.strides.end(), rival_.stride);
  if (place == ladder.strides.end()) return std::nullopt;
  return static_cast<std::size_t>(place - ladder.strides.begin());
}

StrideWeights SingleStrideRival::alone(const StrideLadder& ladder, std::size_t place) const {
  StrideWeights weights{std::vector<double>(ladder.size(), 0.0), std::vector<double>(ladder.size(), 0.0)};
  weights.rotation[place] = rival_.balance.rotation;
  weights.translation[place] = rival_.balance.translation;
  return weights;
}

std::optional<SpreadByPoses> SingleStrideRival::own_spread(const SeenDirections& seen) const {
  if (rival_.problem.blocks.size() < options_.least_blocks) return std::nullopt;
  return spread_by_poses(rival_.problem, seen);
}

std::optional<StrideAlone> SingleStrideRival::without_jumps(const StrideLadder& ladder, TrialSpread& trial,
                                                            const SeenDirections& seen) const {
  const std::optional<std::size_t> place = place_in(ladder);
  if (!place || !has_jumps(ladder, *place, sum_)) return std::nullopt;
  const std::optional<SpreadByPoses> own = own_spread(seen);
  StrideWeights weights = alone(ladder, *place);
  if (!own || !std::isfinite(own->score) || is_rounding(*own, options_) || !trial.set(weights))
    return std::nullopt;
  SpreadByPoses spread = trial.spread(seen);
  if (!std::isfinite(spread.score) || own->score - spread.score < options_.clearly_unpaired ||
      !agree(spread, *own, false, seen, options_))
    return std::nullopt;
  return StrideAlone{std::move(weights), std::move(spread)};
}

bool SingleStrideRival::is_beaten_by(const SpreadByPoses& sum, double mean_stride, bool in_force,
                                     const StrideLadder& ladder, TrialSpread& trial,
                                     const SeenDirections& seen) const {
  const std::optional<SpreadByPoses> own = own_spread(seen);  // the rival as it is, in its own blocks
  const std::optional<std::size_t> place = place_in(ladder);
  const bool shorter = mean_stride < rival_.stride;
  if (!place || (own && !agree(sum, *own, shorter, seen, options_))) return false;
  const bool unpaired = weight_taken_off(ladder) > options_.taken_off ||
                        (has_jumps(ladder, *place, sum_) && own && !is_rounding(*own, options_));
  if (own && std::isfinite(own->score) && unpaired &&
      own->score - sum.score >= (in_force ? 0 : options_.clearly_unpaired))
    return true;

  if (!trial.set(alone(ladder, *place))) return false;
  const SpreadByPoses single = trial.spread(seen);
  if (!std::isfinite(single.score)) return true;
  if (single.influence.size() != sum.influence.size()) return false;
  if (is_rounding(single, options_)) return false;
  const double gain = single.score - sum.score;
  if (in_force) return gain > 0;
  return gain >= std::max(options_.clearly, options_.single_evidence * standard_error(single, sum));
}

}  // namespace egocal::detail
