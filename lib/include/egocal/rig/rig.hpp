// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "egocal/certificate/certificate.hpp"
#include "egocal/pairing/options.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal {

/// The motions of two sensors of a rig as a cost matrix. Sensors are numbered from 0.
struct RigEdge {
  std::size_t a = 0, b = 0;
  Matrix8d Q;  ///< cost_matrix() of T_a_b, 3-D, lengths in metres, any weight
};
EGOCAL_SAME_LAYOUT(RigEdge)

/// Poses of all sensors that fit all pairs best.
struct ConsistentSet {
  /// Whether poses were found. False where the pairs do not connect all sensors, or a cost matrix is not
  /// usable; nothing else is set then.
  bool solved = false;
  std::vector<DualQuaternion> poses;  ///< of every sensor in sensor 0
  /// Standard deviations of these poses, x y z roll pitch yaw in sensor 0's frame [m, rad], by the jack-knife
  /// of the joint minimum itself, with what noisy rotations take off the translations. Only solve_rig() gives
  /// them; otherwise empty.
  std::vector<std::array<double, 6>> stddev{};
  /// Sum over the pairs of J / J_min: each pair's own minimum counts 1, so that noisy pairs count less.
  double cost = 0;
  /// What the pairs would cost one by one, less a margin: `cost` lies above by what the loops do not close.
  double pairwise_bound = 0;
  /// No set of poses has a lower cost than this. Equal to pairwise_bound where nothing better is proven.
  double lower_bound = 0;
  double rounding = 0;  ///< of the cost: what double precision cannot distinguish
  /// Whether the set is globally optimal: cost - lower_bound is at most twice the rounding (docs/rigs.md has
  /// the proof).
  bool certified = false;
};

/// The joint minimum over all pairs and its proof. A certificate needs a pair of sensor 0 with every other
/// sensor, and motions that show all directions. Deterministic, thread-safe, throws nothing.
ConsistentSet solve_consistent_set(std::size_t sensors, std::span<const RigEdge> edges);

/// The motions of two sensors of a rig. Sensors are numbered from 0.
struct RigPair {
  std::size_t a = 0, b = 0;
  Problem problem;                ///< mode, planes and balance; its blocks are not looked at
  std::vector<MotionPair> pairs;  ///< consecutive, in the order of time; outliers are omitted
  /// The pair's answer: motions that fit it far worse than the median one does are rejected. Empty: the
  /// motions' own answer is taken for that.
  std::optional<DualQuaternion> T_a_b;
  /// What the pair's own answer states to be uncertain by, x y z roll pitch yaw [m, rad], infinite where it
  /// is not known: a loop that is off by less contradicts nothing. Empty: nothing is stated.
  std::optional<std::array<double, 6>> stated{};
};

struct RigOptions {
  /// Parts of the drive that the jack-knife of a loop omits, the same times for all pairs. Four times
  /// the parameters of a loop.
  std::size_t blocks = 24;
  double false_alarms = 1e-3;  ///< chance that any loop of a consistent rig is called open
  /// A loop is called open where its misfit also exceeds one of these: odometry has systematic errors that
  /// repeat in every part of a drive (0.5 cm between three Tango devices, docs/rigs.md).
  double least_rotation = 0.15 * std::numbers::pi / 180;  ///< [rad]
  double least_translation = 0.01;                        ///< [m]
  /// Directions that the jack-knife of a loop knows less well say nothing about it. A jack-knife is linear,
  /// and so is its covariance: where an answer changes by metres or by many degrees it means nothing.
  double known_rotation = 2 * std::numbers::pi / 180;  ///< [rad]
  double known_translation = 0.2;                      ///< [m]
  /// Motions for each part of the drive: fewer do not show their spread.
  std::size_t least_motions = 2;
  /// A motion that fits this many times worse than the median one is rejected: five standard deviations.
  double most_residual = 25;
  /// A sensor is blamed where its noise (variance) is this many times that of every other one.
  double blame_ratio = 3;
};

/// Optimum of one pair by itself.
struct RigPairAnswer {
  std::size_t a = 0, b = 0;
  DualQuaternion T_a_b;
  Certificate certificate;
  /// Mean squared residuals of the real and of the dual rows of (14), about a quarter of the mean squared
  /// angle [rad^2] and distance [m^2] by which a motion of b, seen from a, differs from that of a.
  double residual_rotation = 0;
  double residual_translation = 0;
};

/// Three sensors and the misfit of their pairwise answers, T_ab T_bc T_ca, that should be the identity.
struct Loop {
  std::array<std::size_t, 3> sensors{};
  std::array<double, 6> misfit{};  ///< x y z and rotation vector in the frame of the first [m, rad]
  std::array<double, 6> stddev{};  ///< by the jack-knife of the loop, whose answers share their errors, with
                                   ///< what noisy rotations take off the translations (docs/method.md)
  std::size_t known = 6;   ///< directions that are known well enough to judge by; 0: the loop is unknown
  double chi_square = 0;   ///< misfit against its covariance in these: Hotelling's T^2 of `known` components
  double false_alarm = 1;  ///< chance of at least this in a consistent rig
  bool closed = true;      ///< not open; of an unknown loop it says nothing
};

struct RigSolution {
  std::vector<RigPairAnswer> pairs;
  std::vector<Loop> loops;
  /// Poses of all sensors; not solved in planar mode, where the pairs with sensor 0 take its place.
  ConsistentSet set;
  /// What each sensor adds to the residuals of its pairs (three-cornered hat), as a part of the mean; empty
  /// with two sensors.
  std::vector<double> noise;
  std::optional<std::size_t> blamed;  ///< the sensor that stands out by its noise
};

/// All pairs, all loops of three, and the one consistent set of extrinsics that fits all pairs best. Throws
/// Error where a sensor has no pair with sensor 0, a pair has no motions, or the numbers of a pair are not
/// a < b < sensors. Deterministic. Thread-safe.
RigSolution solve_rig(std::size_t sensors, std::span<const RigPair> pairs, const RigOptions& options = {});

struct RigMotionsOptions {
  int stride = 1;  ///< instants of the slowest sensor in one motion
  Balance balance;
  /// Poses further apart are not interpolated between [s], and no motion spans a pause between instants that
  /// is longer, unless all are.
  double max_gap = 0.5;
  std::vector<GroundPlane> planes;  ///< one a sensor: planar mode; any other number of them: 3-D
  ScreeningOptions screening;       ///< a motion that is not congruent in one pair is used in none
};

/// All pairs of a rig, with motions between the same instants for all of them: those of the slowest sensor,
/// the other poses interpolated. The errors of the pairwise answers are then nearly dependent, and the loops
/// close to second order. Trajectories: in the order of time, on one clock. Never throws: where the sensors
/// share no instants the pairs have no motions, and solve_rig() refuses them; fewer than two sensors have no
/// pairs. Deterministic. Thread-safe.
std::vector<RigPair> rig_motions(std::span<const Trajectory> sensors, const RigMotionsOptions& options = {});

}  // namespace egocal
