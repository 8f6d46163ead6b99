// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pairing/offset/refinement.hpp"

namespace egocal::detail {

/// Tuning of OffsetFits besides TimeOffsetOptions.
struct OffsetFitOptions {
  int rounds = 3;          ///< of weighted solutions: two leave less than a percent
  std::size_t parts = 32;  ///< of the drive, as RefinementOptions::blocks
  /// Interpolated through so few poses the motions change by more than the interpolation is wrong. One motion
  /// of so many shows it.
  std::size_t coarse_poses = 4, coarse_each = 8;
  std::size_t least_parts = 6;  ///< fewer show no scatter
};

/// How well an extrinsic explains the motions of two streams under several clocks. Motions between stamps
/// cannot tell: an interpolated pose has less noise than a measured one, and where the stamps coincide both
/// streams have the same interpolation errors. So the motions begin at times spread evenly between the poses
/// of both.
class OffsetFits {
 public:
  /// a, b: without glitches. Both and the schedule must outlive the object.
  OffsetFits(const Trajectory& a, const Trajectory& b, const TimeOffsetOptions& options,
             std::int64_t max_gap_us, Schedule& schedule, const OffsetFitOptions& tuning = {});

  /// Adds the work for one more clock to the schedule. start: an extrinsic to start from.
  void add(const ClockLine& clock, const DualQuaternion& start);

  /// By how much the first clock is worse than the second, over the motions known under both.
  struct Comparison {
    double gain = 0;    ///< mean logarithm of the ratio of the squares, above their noise
    double sigmas = 0;  ///< Student's t of the gains of the parts of the drive
    double chance = 1;  ///< of as much where both fit equally well
  };
  /// Compares two clocks; empty where they have too little in common.
  std::optional<Comparison> compare(std::size_t first, std::size_t second) const;

  std::size_t size() const { return fits_.size(); }

 private:
  /// Squares of what the extrinsic leaves of one motion (18).
  struct Left {
    double rotation = 0, translation = 0;
    bool known = false;
  };
  /// What an extrinsic leaves of the motions under one clock.
  struct Fit {
    std::vector<Left> left;   ///< by motion
    double square_lever = 0;  ///< of its translation [m^2]
  };
  struct Sampled {
    MotionPair motion;
    bool known = false;
  };

  double time_us(std::size_t k) const;
  void find_floor(const Trajectory& poses);
  void sample(const ClockLine& clock, std::size_t begin, std::size_t end);
  void fit();
  void set_left();

  const Trajectory &a_, &b_;
  TimeOffsetOptions options_;
  OffsetFitOptions tuning_;
  double max_gap_us_;
  Schedule& schedule_;
  double period_us_ = 0;                   ///< of the slower stream
  double length_us_ = 0, spacing_us_ = 0;  ///< of the motions
  std::size_t count_ = 0;                  ///< of the motions
  Left floor_;                             ///< squares that say nothing: of rounding and of interpolation
  std::vector<Sampled> sampled_;           ///< under the newest clock
  DualQuaternion extrinsic_;               ///< and what is found under it
  std::vector<Left> left_;                 ///< of the motions by this extrinsic
  std::vector<Fit> fits_;                  ///< by clock
};

}  // namespace egocal::detail
