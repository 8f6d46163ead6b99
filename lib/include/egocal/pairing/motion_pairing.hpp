// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/pairing/clock_offset.hpp"
#include "egocal/pairing/congruence.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/problem.hpp"
#include "egocal/robust/robust_statistics.hpp"

namespace egocal {

/// How motions are made from two streams of poses, and what the solvers are to minimise.
struct PairingOptions {
  Mode mode = Mode::spatial;
  GroundPlane plane_a{}, plane_b{};  ///< planar mode
  std::optional<int> stride{};  ///< steps of the slower stream in one motion; empty: chosen by the jack-knife
  std::optional<Balance> balance{};  ///< empty: chosen by the jack-knife
  double time_offset = 0;            ///< added to the stamps of b before pairing [s]
  bool track_time_offset =
      false;             ///< find it from the streams instead (poses are held until then), follow its drift
  double max_gap = 0.5;  ///< poses further apart are never interpolated between [s]
  bool robust =
      true;  ///< leave out poses that are not screw congruent and motions that contradict the others
  std::optional<DualQuaternion> prior{};  ///< handed on to the problem
};

/// Why a pose or a motion is not in the statistics.
enum class Rejection {
  not_finite,        ///< NaN, infinity or a quaternion far from unit length
  out_of_order,      ///< known, or so late that poses after it have been paired
  no_partner,        ///< the other stream has no pose on one side of it (before its start, after its end)
  gap,               ///< the neighbours in the other stream, or the two ends of the motion, are too far apart
  frozen,            ///< one sensor repeats its pose to the last digit while the other one moves
  screw_congruence,  ///< the motions to and from a pose differ in angle or slide by more than noise explains
  too_much_rotation,  ///< so near to half a turn that the sign of its quaternion is a guess
  count_
};
std::string_view name(Rejection reason);

struct PairingCounts {
  std::uint64_t poses_a = 0, poses_b = 0;  ///< handed in
  std::uint64_t synchronised = 0;          ///< instants for which both poses are known
  std::uint64_t matched = 0;               ///< motion pairs in the statistics (of the chosen stride)
  std::uint64_t outliers =
      0;  ///< motion pairs (of the chosen stride) that contradict the others; may come back
  std::array<std::uint64_t, static_cast<std::size_t>(Rejection::count_)> rejected{};
};

/// The setting that is in force and why.
struct Choice {
  int stride = 1;
  Balance balance;
  std::string reason;  ///< "fixed", or the jack-knife's numbers in a short sentence
};

/// Poses of both sensors at one time; motions never span two chains.
struct Instant {
  std::int64_t time_us = 0;
  DualQuaternion a, b;
  std::uint64_t chain = 0;
};

/// Everything that a MotionPairing remembers; bounded whatever the length of the drive. Continuing from a
/// copy gives the same bits as never having stopped.
struct PairingState {
  struct PerStride {
    int stride = 1;
    RobustStatistics statistics;
  };

  PairingCounts counts;
  Choice choice;
  ClockState clock;                                      ///< only where the time offset is tracked
  std::array<std::optional<std::int64_t>, 2> newest_us;  ///< of each stream, b's with the offset
  std::array<std::deque<StampedPose>, 2> waiting;  ///< not yet synchronised; the faster one keeps a neighbour
  std::optional<Side> keys;                        ///< the slower stream, at whose stamps poses are paired
  std::int64_t period_us = 0;                      ///< typical, of the slower stream
  std::optional<std::int64_t> last_key_us;         ///< newest stamp that was paired or given up
  std::deque<Instant> instants;                    ///< the newest, as many as the longest motion needs
  std::uint64_t chain = 0;
  std::vector<PerStride> strides;
  std::uint64_t next_choice = 0;  ///< number of instants at which to choose again
  CongruenceScale congruence;     ///< what differences between the motions are typical
  std::optional<Instant> newest;  ///< synchronised, whatever became of it
  std::vector<Instant> unjudged;  ///< the first ones, while it is not known what is typical
  std::deque<Instant> doubtful;   ///< newer than instants, not congruent with the newest of them
};

/// From two streams of poses to the problem, one pose at a time: synchronises by screw interpolation of the
/// faster stream at the stamps of the slower one, leaves out poses that are not screw congruent, forms
/// motions, accumulates them in blocks for every stride under consideration, leaves out blocks that
/// contradict the others, and chooses stride and balance. Used offline and by egocal-pairing alike; the
/// result depends on the poses of each stream alone, not on how the two streams interleave.
class MotionPairing {
 public:
  explicit MotionPairing(PairingOptions options);
  MotionPairing(PairingOptions options, PairingState state);

  /// Takes in the next pose of one stream. Returns the motion pairs of the chosen stride that it completed.
  std::vector<MotionPair> push(Side side, const StampedPose& pose);

  /// No more poses will come: pairs what a drive too short to tell its slower stream has held back.
  std::vector<MotionPair> finish();

  /// What is known so far.
  Problem problem() const;
  const Choice& choice() const { return state_.choice; }
  const PairingCounts& counts() const { return state_.counts; }
  const PairingOptions& options() const { return options_; }
  const PairingState& state() const { return state_; }
  std::optional<std::int64_t> newest_us() const;  ///< time of the newest synchronised instant [us]
  /// What is added to the stamps of b. Empty while it is looked for.
  std::optional<double> time_offset() const;

 private:
  void reject(Rejection reason) { ++state_.counts.rejected[static_cast<std::size_t>(reason)]; }
  std::vector<MotionPair> take(Side side, const StampedPose& pose);
  void decide_keys();
  std::vector<MotionPair> synchronise();
  void judge(const Instant& instant, std::vector<MotionPair>& pairs);
  void judge_first_ones();
  void speak_for(const std::vector<Instant>& witnesses, const Instant& instant,
                 std::vector<MotionPair>& pairs);
  void accept(Instant instant, std::vector<MotionPair>& pairs);
  Problem empty_problem() const;
  std::optional<MotionPair> motion(const Instant& from, const Instant& to, int stride, bool count_rejections);
  void choose();

  PairingOptions options_;
  DualQuaternion G_a_, G_b_;  ///< planar mode: ground frames in the sensors
  PairingState state_;
};

/// Both trajectories through a MotionPairing, in the order of time.
struct PairingResult {
  MotionPairing drive;
  std::vector<MotionPair> pairs;  ///< of the stride in force when each was completed
};
PairingResult pair_motions(const PairingOptions& options, const Trajectory& a, const Trajectory& b);

}  // namespace egocal
