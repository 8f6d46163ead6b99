// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions in other axes than the rotations of the same stream: exchanged or mirrored columns, another world
// frame, or the rotation of the inverse pose.
#pragma once

#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/degrees.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// Readings of one stream that could explain the motions, the other stream as it is. The orthogonal matrix is
/// found by linear least squares: with W free, R_a t + t_a = R_T R_b' W d + t is linear in W and t. Where the
/// best one is near a signed permutation, that one is included; the identity never. At most `most` motions
/// over `stride` instants are looked at.
std::vector<PoseReading> axes_readings(const Instants& instants, Side wrong, int stride, std::size_t most,
                                       const DiagnosisOptions& options);

/// When turned axes explain the motions. Odometries that drift turn their positions against their rotations a
/// little: by up to 4.6 degrees in the 13 runs of the public benchmark with drift, with gains up to 0.54.
struct TurnedAxesOptions {
  double small = 10 * radians_per_degree;  ///< [rad]
  double gain_of_small = 1;                ///< mean log ratio of the squared residuals, at least
  /// The gain for a finding that is uncertain: above the benchmark's 0.54; 1,260 clean simulated drives have
  /// at most 0.2.
  double possible_gain_of_small = 0.6;
};

/// When inverse rotations of both streams explain the motions. Clean drives (638 and 78 of two simulators,
/// noise on motions and on poses, white and wandering): where the gain is more than 0.1, at most 0.3 in
/// metres. Wrong ones of two to three minutes: 0.9 to 7 and 2.2 to 8; motorways, KITTI with orb, and drives
/// of 30 s with noise of 1 %: 0.2 to 0.6 and 0.7 to 1.5.
struct CommonAxesOptions {
  double gain = 1;            ///< mean log ratio of the squared residuals, at least
  double gain_in_metres = 2;  ///< the same of the translations alone [m^2]
  /// The gains for a finding that is uncertain, and the standard deviations of the comparison.
  double possible_gain = 0.2, possible_gain_in_metres = 0.6, possible_sigmas = 2;
  /// The gains where a mount seems to move as given, and does not with inverse rotations: EuRoC's drone has
  /// 0.16 and 0.31.
  double gain_beside_move = 0.1, gain_beside_move_in_metres = 0.25;
};

/// Rotations, or positions, that are those of the inverse pose.
std::vector<PoseReading> inverse_rotation_readings();

/// Readings of both streams alike: inverse_rotation_readings(), and positions in other axes. One program
/// wrote both files.
std::vector<PoseReading> common_axes_readings(const Instants& instants, int stride, std::size_t most,
                                              const DiagnosisOptions& options);

/// Whether the matrix only exchanges and mirrors axes.
bool is_permutation(const Eigen::Matrix3d& axes);

/// Rotation vector of a turn, but for mirroring at the origin [rad].
Eigen::Vector3d turn_of(const Eigen::Matrix3d& axes);

}  // namespace egocal::detail
