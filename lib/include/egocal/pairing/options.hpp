// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Options of every stage between two streams of poses and the problem.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "egocal/pairing/clock_options.hpp"
#include "egocal/pairing/congruence_options.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal {

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
  /// 6 s (design, section 3 point 7).
  double longest_motion = 8;
  /// A motion may take this many times as long as its stride says: lost poses make longer motions, standing
  /// still for minutes does not make one.
  double stretch = 4;
  /// Motions that rotate by more are rejected, for the sign of their quaternion is a guess [rad].
  double most_rotation = 170 * std::numbers::pi / 180;
  /// Translation weights that are tried at a rotation weight of 1 [1/m^2] (design, section 3 point 7).
  std::vector<double> balances{1, 0.1, 0.01, 0.001};
  /// Number of synchronised instants at which stride and balance are chosen first. Each further choice comes
  /// after a quarter more: the cost of choosing stays a constant part of the work.
  std::uint64_t first_choice = 64;
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
