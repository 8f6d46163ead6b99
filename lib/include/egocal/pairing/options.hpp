// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Options of every stage between two streams of poses and the problem.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "egocal/problem/problem.hpp"

namespace egocal {

/// Tuning of the ClockFollower. Study: tests/lib/test_time_offset.cpp, over noise, glitches, drift and
/// interleaving.
struct ClockOptions {
  double first = 10;     ///< length of the first estimate's streams, and of what each next one adds [s]
  double every = 30;     ///< between estimates once one is in force [s]: quartz changes over minutes
  double delay = 2;      ///< from the end of an estimate's streams until it comes into force, at least [s]
  double window = 60;    ///< newest part of the streams that an estimate looks at once one is in force [s]
  double longest = 180;  ///< poses are held for at most this long, and until the first estimate looked at [s]
  std::size_t most_held = 200'000;  ///< poses of one stream: 180 s at 1 kHz
  /// Below these an estimate is not trusted: unrelated streams reach a correlation of 0.5 by chance.
  double least_correlation = 0.7, least_inliers = 0.5;
  double largest_stddev = 0.005;  ///< [s]: at 1 rad/s an error of 0.3 deg
  /// Another offset comes into force where it differs by both [s, standard deviations].
  double least_change = 0.005, change_sigmas = 4;
  /// Share of the estimate that is worked out at each pose, in poses looked at: 0.2 to 0.7 ms.
  std::size_t work_per_pose = 512;
  double phase = 0;  ///< in [0, 1): several pairs of one rig estimate at different times
};

/// Tuning of the test whether two motions are screw congruent. Study: tests/bench/outlier_study.cpp, wrong
/// poses of seven kinds in real and simulated drives; docs/accuracy.md, "Gross outliers", has its table.
struct CongruenceOptions {
  /// Below this angle a motion has no screw axis to slide along [rad]. 1.1 degrees: a noise of a tenth of a
  /// degree turns the axis of smaller motions by more than five degrees.
  double least_turn = 0.02;
  /// Differences of angles and lengths that are rounding alone [rad, m]: six printed digits of a quaternion,
  /// five of a position. They keep exact streams from being measured in standard deviations of zero.
  double angle_floor = 1e-6, length_floor = 1e-5;
  /// Newest motions that show what is typical: 100 s at 10 Hz, so that a drive from a car park onto a road
  /// is judged by the road.
  std::size_t memory = 1024;
  /// Motions before the first estimate: a quartile of each half of them has six values on either side. Study:
  /// wrong poses among the first two dozen are found when these are screened again.
  std::size_t first_estimate = 24;
  /// Motions between estimates while the memory fills; once it is full, between those of one of the four in
  /// turn: a quarter of it is new then. Study: docs/benchmarks.md, "The command `egocal solve`".
  std::uint64_t estimate_every = 16, estimate_every_when_full = 64;
  /// One of this number of motions of doubtful poses is remembered: they may be wrong, or the beginning of
  /// noisier seconds, which the estimate must follow after a while.
  std::uint64_t doubtful_remembered = 8;
  /// Noise that grows with the motion is at most this part of it: with more no odometry is left to compare.
  double most_growing = 0.2;
  /// Motions smaller than `still` of the larger ones are those of a vehicle that stands: its errors are
  /// others. Of motions more than `beyond` times as large as those that were seen nothing is known but that
  /// their lengths agree, with `unknown_noise` of them as noise: standing at the start says nothing of
  /// driving. Study: drives that stand for 40 to 1000 s at their begin and on the way, exactly or with a
  /// jitter of 1e-9 to 1e-3 m; up to all poses that followed were rejected before.
  double still = 0.01, beyond = 10, unknown_noise = 0.05;
  /// No odometry differs by more from one pose to the next, however noisy it is just now: an angle [rad], and
  /// lengths as a multiple of the mean of the longer half of the motions. Study: jumps within noisy seconds.
  double gross_angle = 20 * std::numbers::pi / 180, gross_lengths = 10;
  /// How large the lever arm between the sensors may be [m]. It explains why the lengths of their motions
  /// differ while the vehicle turns. 10 m cover cars and trucks; trailers, cranes and ships need more.
  double longest_lever_arm = 10;
  /// The length of the lever arm and the noise of turning are learnt from the motions that turn more than
  /// others. A motion that turns by more than `turns_more` times the larger half of those seen may show the
  /// longest arm, and has at least this part of its angle as noise. Study: AGVs that turn in place after 3 s
  /// straight, 5 kinds of noise x 40 drives of 100 poses; the whole first turn was rejected in about a third
  /// of them (docs/accuracy.md).
  double noise_of_turns = 0.01;
  double turns_more = 3;
};

/// Tuning of the Synchroniser.
struct SynchroniserOptions {
  /// Poses of each stream that show which one is slower. Eight give a median period that one lost pose does
  /// not change.
  std::size_t poses_to_decide = 8;
  /// Poses of one stream that wait for the other one. 40 s at 100 Hz; a silent partner costs no more memory.
  std::size_t most_waiting = 4096;
  /// The stream of a gives the stamps only if its period is longer than b's by this factor. Streams of one
  /// rate jitter by a few percent and must not swap roles from drive to drive.
  double slower_by = 10.0 / 9.0;
  /// Interpolation cuts the corners of the path of the interpolated stream. The pose that it is paired with
  /// is moved towards the path between its own neighbours, so that both cut corners alike. There are two
  /// exceptions: the move would be more than most_cut of the distance to that path (beyond 1 it crosses it:
  /// poses of the interpolated stream are missing), or the pose is off that path by more than most_bent
  /// typical steps, the median of the last `typical_steps` (an outlier or a jump). Study: docs/method.md,
  /// "Interpolation".
  bool cut_alike = true;
  double most_cut = 4, most_bent = 1;
  std::size_t typical_steps = 9;  ///< two outliers are four steps
  /// Number of poses of the faster stream, half of them on each side of an instant, from which the pose there
  /// is interpolated (universal kriging with a Gaussian correlation over correlation_length periods). A screw
  /// between two poses is used instead, and both streams are cut alike, if one of the poses is off the path
  /// between its neighbours by more than most_rough typical steps, if the period at the instant is more than
  /// most_uneven_here times the typical one, or if another period is more than most_uneven times as long or
  /// short. Even, at most most_smooth_poses; 0: never. Study: docs/method.md, "Interpolation".
  std::size_t smooth_poses = 8;
  double correlation_length = 1.5, most_rough = 2, most_uneven_here = 1.5, most_uneven = 3;
  static constexpr std::size_t most_smooth_poses = 16;  ///< bounds the time of one interpolation
};

/// Tuning of the Screening. Distances from congruence are in standard deviations of the typical difference.
/// Study: tests/bench/outlier_study.cpp, its table in docs/accuracy.md, "Gross outliers".
struct ScreeningOptions {
  /// A motion further off than this is doubtful: its newer pose waits for the next ones to confirm it.
  /// Real odometry has heavy tails; tests/lib/test_congruence.cpp measures them on the drives of the study.
  double doubtful = 10;
  /// Between poses that others confirm, only what is further off than this ends a chain: heavy tails belong
  /// to the odometry, jumps do not.
  double break_chain = 40;
  /// Poses that wait for a confirmation. Three that agree begin a new chain; five leave room for two glitches
  /// among them.
  std::size_t most_doubtful = 5;
  /// A pose that differs by less from the one before repeats it: a part of its distance from the origin, and
  /// of 1 m. What interpolation between equal poses rounds to.
  double repeated = 1e-14;
  CongruenceOptions congruence{};
};

/// Tuning of the Accumulator.
struct AccumulatorOptions {
  /// Longer motions are not considered when the stride is chosen [s]. The robot arm's best motions take 3 to
  /// 6 s. Study: docs/method.md, "Sums over strides".
  double longest_motion = 8;
  /// A motion may take this many times as long as its stride says: lost poses make longer motions, standing
  /// still for minutes does not make one.
  double stretch = 4;
  /// Motions that rotate by more are rejected, for the sign of their quaternion is a guess [rad].
  double most_rotation = 170 * std::numbers::pi / 180;
  /// Translation weights that are tried at a rotation weight of 1 [1/m^2]; smaller ones where that is not
  /// enough (docs/method.md, "Fast machines").
  std::vector<double> balances{1, 0.1, 0.01, 0.001};
  /// Number of synchronised instants at which stride and balance are chosen first. Each further choice comes
  /// after a quarter more: the cost of choosing stays a constant part of the work.
  std::uint64_t first_choice = 64;
  /// Before the first choice, answers are of a choice that is made for them, from this many instants on, and
  /// that nothing later depends on. With equal weights drives of 20 to 60 poses are off by three times as
  /// much; from fewer than 16, one answer in a hundred is called good and is off (docs/weights.md, "From how
  /// many poses on").
  std::uint64_t early_choice = 16;
  /// Share of the instants to the next choice by which each choice comes later, in [0, 1): several pairs of
  /// one rig choose at different times.
  double choice_phase = 0;
};

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
  bool robust = true;    ///< reject poses that are not screw congruent and motions that contradict the others
  std::optional<DualQuaternion> prior{};  ///< handed on to the problem

  ClockOptions clock{};
  SynchroniserOptions synchroniser{};
  ScreeningOptions screening{};
  AccumulatorOptions accumulator{};
};

/// The options, with unit normals of the planes. Throws Error naming the option that is not finite or out of
/// its range (egocal/limits.hpp).
PairingOptions validated(PairingOptions options);

}  // namespace egocal
