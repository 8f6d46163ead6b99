// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions in other axes than the rotations of the same stream: exchanged or mirrored columns, another world
// frame, or the rotation of the inverse pose.
#pragma once

#include <vector>

#include "diagnosis/motions.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// Readings of one stream that could explain the motions, the other stream as it is. The orthogonal matrix is
/// found by linear least squares: with W free, R_a t + t_a = R_T R_b' W d + t is linear in W and t. Where the
/// best one is near a signed permutation, that one is included; the identity never. At most `most` motions
/// over `stride` instants are looked at.
std::vector<PoseReading> axes_readings(const Instants& instants, Side wrong, int stride, std::size_t most,
                                       const DiagnosisOptions& options);

/// The same of both streams, read alike: one program wrote both files.
std::vector<PoseReading> common_axes_readings(const Instants& instants, int stride, std::size_t most,
                                              const DiagnosisOptions& options);

/// Whether the matrix only exchanges and mirrors axes.
bool is_permutation(const Eigen::Matrix3d& axes);

}  // namespace egocal::detail
