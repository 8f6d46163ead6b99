// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mount that shakes within seconds: the rotation between the sensors changes much in a short time, and by
// no more in a longer one. The drift of an odometry goes on growing; the noise of single poses is as large in
// the shortest time.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

/// Study: docs/moves.md, "Sway".
struct SwayOptions {
  /// Root mean square of the change [rad]: larger than attitude errs in such a time, 1.4 times the standard
  /// deviation of the rotation.
  double least = 1.25 * radians_per_degree;
  double longest_time = 30;         ///< in which it changes so [s]: a heading may err slowly
  double next_stride = 1.25;        ///< each as a multiple of the one before
  std::size_t most_motions = 500;   ///< of one stride, evenly spread
  std::size_t least_motions = 8;    ///< of one stride
  double longest_stride = 1.0 / 3;  ///< as a part of the drive
  /// Part of the squared changes, the largest ones, that does not count: one pose in twenty that is wrong in
  /// each stream is in a tenth of the changes in one step, and in a third of the changes in a time. Where a
  /// mount is loose half of the changes show it.
  double largest_part = 1.0 / 3;
  double before = 1.0 / 8;               ///< of the time: there the change is smaller
  double most_before = 0.5;              ///< as a part of the change; random walks have 0.35
  double flat_until = 4, looked_at = 8;  ///< times the time: the change is as large there
  double most_after = 1.15;              ///< as a part of the change; random walks reach 2
  double fallen = 0.6;                   ///< or it falls below this part before flat_until: a period
  /// The change is at least this many times what the better interpolation (UndersamplingOptions::poses)
  /// changes in the rotations between poses: a vehicle that shakes faster than a sensor measures sways as
  /// well. Swaying mounts have 400 and more, such vehicles 9 (docs/moves.md, "Sway").
  double of_interpolation = 30;
};

/// How much the rotation between the sensors changes in a time.
struct RotationChange {
  double time = 0;         ///< [s]
  double mean_square = 0;  ///< [rad^2]
};

/// Mean square of the change of the rotations at an instant by interpolation through `poses` poses [rad^2];
/// zero where no pose is interpolated.
double mean_square_by_interpolation(const Instants& instants, std::size_t poses,
                                    const SwayOptions& options = {});

/// Changes of the rotation between the sensors at T_a_b, over times from that between two instants to a third
/// of the drive.
std::vector<RotationChange> rotation_changes(const Instants& instants, const DualQuaternion& T_a_b,
                                             const MotionSampleOptions& motions,
                                             const SwayOptions& options = {});

/// The largest change that has grown and does not grow further.
std::optional<RotationChange> sway(const std::vector<RotationChange>& changes,
                                   const SwayOptions& options = {});

/// Finding mount_moved, uncertain: a filter may give a stream such an attitude. Spatial mode.
std::optional<Finding> swaying_mount(const Instants& instants, const Answered& answered,
                                     const DiagnosisOptions& options);

}  // namespace egocal::detail
