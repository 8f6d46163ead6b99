// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "pairing/offset/offset_fits.hpp"
#include "pairing/offset/refinement.hpp"

namespace egocal::detail {

/// Tuning of the CandidateComparison besides TimeOffsetOptions.
struct CandidateOptions {
  /// Student's t by which a refined offset must fit better than the preferred one. The mean of the squares
  /// grows with the square of an error of the offset: this is twice as much of the offset itself, as
  /// ClockCheckOptions::sigmas.
  double sure = 2.5;
};

/// Compares offsets that the turning rates allow, by how well an extrinsic explains the motions with each.
/// The rate of turning may repeat when its direction or the way does not: half a figure eight later a vehicle
/// turns as fast, but the other way.
class CandidateComparison {
 public:
  /// The arguments of a Refinement.
  CandidateComparison(const Trajectory& a, const Trajectory& b, const TimeOffsetOptions& options,
                      std::int64_t max_gap_us, Schedule& schedule, std::function<void()> done,
                      const CandidateOptions& tuning = {});

  /// Refines and compares the offsets. Of those that fit equally well it takes the one nearest to
  /// `preferred_us`. All have the same at_b_us; the first one is exact already. arm_us: error of the others
  /// at most.
  void begin(std::vector<ClockLine> starts, double arm_us, double preferred_us);

  /// Whether the first one was taken.
  bool first() const { return taken_ == 0; }
  /// The one that was taken, unless it is the first.
  const ClockLine& clock() const { return candidates_[taken_]; }
  /// Whether no other one fits as well.
  bool alone() const { return nearest_us_ == 0; }
  /// Distance from the offset taken to the nearest and to the farthest other one that fits as well [us].
  double nearest_us() const { return nearest_us_; }
  double farthest_us() const { return farthest_us_; }
  /// Distance from the offset taken to the preferred one, if that fits as well without refinement [us]; else
  /// 0.
  double unsure_us() const { return unsure_us_; }

 private:
  void refine_next();
  void take_refined();
  void add_preferred();
  bool worse(std::size_t one, std::size_t than) const;
  void choose();

  const Trajectory &a_, &b_;
  TimeOffsetOptions options_;
  CandidateOptions tuning_;
  std::int64_t max_gap_us_;
  Schedule& schedule_;
  std::function<void()> done_;

  std::vector<ClockLine> starts_;
  double arm_us_ = 0, preferred_us_ = 0;
  std::size_t next_ = 0;
  std::optional<Refinement> refinement_;
  std::vector<ClockLine> candidates_;
  std::vector<DualQuaternion> extrinsics_;  ///< of each candidate
  std::optional<OffsetFits> fits_;          ///< of each candidate, then of the preferred offset as it is
  std::optional<std::size_t> twin_;  ///< the candidate that the preferred offset became when it was refined
  std::size_t taken_ = 0;
  double nearest_us_ = 0, farthest_us_ = 0, unsure_us_ = 0;
};

}  // namespace egocal::detail
