// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// One list whose positions are in other axes than its rotations: exchanged or mirrored columns, left-handed
// axes, or rotations of the inverse pose.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diagnosis/motions/reading.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/samples/calibrate_samples.hpp"

namespace egocal::detail {

struct ListAxesOptions {
  /// Columns are looked for from this many samples on: each has three numbers, and there are 15 unknowns.
  std::size_t least_for_columns = 7;
};

/// Readings of one list that may explain the samples, the other list as it is. Poses in left-handed axes,
/// rotations included, have the same rotations as right-handed ones with the opposite positions, each in axes
/// of its own. So positions mirrored at the origin stand for all of them. Other columns are those nearest to
/// the matrix W that suits the positions best, a linear fit: with the rotations known,
/// R_a t_X + t_a = R_Y W t_b + t_Y. rounds_of_signs: as in rotations_alone().
std::vector<PoseReading> list_axes_readings(std::span<const PoseSample> samples, Side wrong,
                                            int rounds_of_signs, const ListAxesOptions& options = {});

}  // namespace egocal::detail
