// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whether both streams are of one drive: they travel together, and in every part of it they turn together.
// "Study" is tests/bench/mistake_study.cpp.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct OneDriveOptions {
  std::size_t least = 20;    ///< motions that travel; fewer agree by chance
  double same = 1e-9;        ///< angles that agree to this part are equal to the digits of their files
  std::size_t windows = 10;  ///< of the drive; a part of another drive is found to a tenth
  /// Angles of a window agree where they differ by less than this part, and may disagree from there on: noise
  /// of a tenth of every motion stays below 0.2 in the study, unlike drives are above 0.3.
  double agree = 0.25, disagree = 0.15;
  double step = 4;  ///< least ratio, of these parts and of the angles, to windows that agree
  /// Part of the motions that agree as the other windows do, by chance: more than a third, and wrong poses
  /// explain the rest (two of three motions have an end at one where a third of the poses are wrong).
  double most_agreeing = 1.0 / 3;
  /// Lengths of the motions agree where their ratio scatters by less than this part of the lengths themselves
  /// (median deviations of the logarithms): an odometry measures how far it travels well where it hardly
  /// turns. 5,313 pairs of unrelated drives, of 14 simulated kinds and real ones, are above 0.29; sensors of
  /// one train in noise that hides its curves are at 0.01 to 0.2.
  double lengths_agree = 0.25;
  double least_turning = 0.3;  ///< of the typical motion; a window that turns less says nothing
};

/// Both streams travel alike, by more than chance: they are of one drive, whatever their rotations say. Where
/// the speed does not change this cannot be known.
bool travel_together(const Motions& motions, const OneDriveOptions& options = {});

/// unrelated, with the time from which on: part of the drive does not turn together, the rest does.
std::vector<Finding> unrelated_part(const Motions& motions, const OneDriveOptions& options = {});

}  // namespace egocal::detail
