// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/scale/interpolation_loss.hpp"
#include "egocal/scale/solve_scale.hpp"

namespace egocal {

struct ScaleDriveOptions {
  /// Options of the pairing. Its stride and its rejection of poses are not used: at a wrong scale no motion
  /// is screw congruent. A fixed balance is used; where it is empty, the balance follows from the noise of
  /// the motions.
  PairingOptions pairing;
  ScaleOptions scale;  ///< its mode and balance are replaced by those of the pairing
  /// Length of a motion [s]: long enough to be more than noise, short enough to be many; as offline
  /// (DriveScaleOptions::first_motion).
  double motion = 1;
  /// Motions that begin within the length of one. With four, a sum over blocks has a standard deviation that
  /// is 4 % larger than that of independent blocks.
  std::size_t starts = 4;
  /// A motion that fits this many times worse than the median one is an outlier. Five standard deviations.
  double most_residual = 25;
  /// The newest motions are judged again at each solution, as many as this: two minutes. Older ones are
  /// judged once more and then part of the sums for good.
  std::size_t most_recent = 512;
  std::size_t first_solution = 48;  ///< motions: six blocks, the least that show a standard deviation
  /// Motions of one block, at least. Two seconds: neighbouring blocks share less than a second.
  std::size_t least_block = 8;
  /// Each further solution comes after this part more motions, and after this many at the latest. The cost of
  /// solving stays a constant part of the work; a display follows within some seconds.
  double growth = 0.02;
  std::size_t longest_wait = 64;
  int passes = 6;  ///< a limit: motions are judged and the rest is solved alternately
  /// More blocks of old motions than this are joined, two by two. With most_recent_blocks of the newest ones
  /// they are no more than a problem on the wire may hold (64).
  std::size_t most_old_blocks = 32, most_recent_blocks = 32;
  /// What the lengths of the interpolated stream lose is part of the scale's standard deviation. Its `motion`
  /// and `starts` are replaced by those above.
  InterpolationLossOptions interpolation;
};

/// What a solver of the scale needs.
struct ScaleProblem {
  std::vector<ScaleStatistics> blocks;
  ScaleOptions options;
};

/// Everything that a ScaleDrive remembers. Bounded. Continuing from a copy gives the same bits as never
/// having stopped.
struct ScaleDriveState {
  PairingState pairing;
  std::vector<MotionPair> open;      ///< motions that are still too short, oldest first
  std::vector<MotionPair> recent;    ///< the newest motions, in the order of time
  std::vector<ScaleStatistics> old;  ///< blocks of older ones
  std::uint64_t old_block = 0;       ///< motions of one block of them
  std::uint64_t motions = 0;         ///< ever
  std::uint64_t left_out = 0;        ///< of the older ones
  std::uint64_t next_solution = 0;   ///< at this number of motions
  std::uint64_t solved_motions = 0;  ///< number of motions at the newest solution
  std::uint64_t solved_left_out = 0;
  std::int64_t solved_us = 0;  ///< end of the newest motion in it [us]
  std::int64_t step_us = 0;    ///< length of the newest single step [us]
  double limit = 0;            ///< residual beyond which a motion is an outlier; 0: unknown
  std::optional<Balance> balance;
  InterpolationLossState interpolation;
  std::optional<ScaleProblem> problem;  ///< of the newest solution
  ScaleSolution solution;
};

/// From two streams of poses, of which one has an unknown scale, to the scale and the problem at it, one pose
/// at a time. The scale statistics serve every scale, so nothing is lost while it is unknown and nothing is
/// counted twice when it changes. The result depends on the poses alone. Not thread-safe.
class ScaleDrive {
 public:
  /// Throws Error where a pairing option is out of its range.
  explicit ScaleDrive(const ScaleDriveOptions& options);
  ScaleDrive(const ScaleDriveOptions& options, ScaleDriveState state);

  /// Takes the next pose of one stream. Returns the motions that it completed, at the scale in force.
  std::vector<MotionPair> push(Side side, const StampedPose& pose);
  /// Motions of poses that were held back, as MotionPairing::release_held() gives them.
  std::vector<MotionPair> release_held() { return taken(pairing_.release_held()); }

  /// The scale problem of the newest solution, for others to solve; empty before the first one.
  const std::optional<ScaleProblem>& scale_problem() const { return state_.problem; }
  const ScaleSolution& solution() const { return state_.solution; }
  /// Whether the scale is certified and observable, and so in force.
  bool known() const;
  /// The problem at the scale in force, from the motions of the newest solution; empty while it is unknown.
  std::optional<Problem> problem() const;
  /// Poses, clock and synchronisation.
  const MotionPairing& pairing() const { return pairing_; }
  /// Counts of the pairing; the motions are those of the newest solution.
  PairingCounts counts() const;
  Choice choice() const;
  std::uint64_t motions() const { return state_.motions; }
  std::uint64_t solved_motions() const { return state_.solved_motions; }
  std::int64_t solved_us() const { return state_.solved_us; }
  ScaleDriveState state() const;

 private:
  std::int64_t on_clock_of_a(Side side, std::int64_t time_us) const;
  std::vector<MotionPair> taken(const std::vector<MotionPair>& steps);
  void grow(const MotionPair& step, std::vector<MotionPair>& completed);
  void commit_old();
  void join_old_blocks();
  void solve();
  std::vector<MotionPair> kept() const;
  std::vector<ScaleStatistics> blocks_with(std::span<const MotionPair> recent) const;
  Side side() const { return options_.scale.side; }

  ScaleDriveOptions options_;
  MotionPairing pairing_;
  InterpolationLoss interpolation_;
  ScaleDriveState state_;  // without those of the two
};

}  // namespace egocal
