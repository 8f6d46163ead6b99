// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/cost.hpp"
#include "offline/drives/append.hpp"
#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// The motions as they were read.
struct Motions {
  Trajectory a, b;  ///< from trajectories or a log
  bool a_has_scale = true, b_has_scale = true;
  std::vector<MotionPair> pairs;  ///< from a file of pairs
  std::vector<std::string> warnings;
};

/// Runs what reads both files. Where one file of times was given for both and one has times of its own, the
/// Error also says which options give the times of one file.
void with_times_of_both(const MotionSource& source, const std::function<void()>& read);

/// Throws Error naming the file or the channel that cannot be read.
Motions read_motions(const MotionSource& source);

/// Appends the further drives, each after the ones before it. Result: of `motions`, which must exist as long.
/// Throws UsageError where there are none to append to, or one of two files is missing.
Drives append_drives(const SolveRequest& request, Motions& motions);

}  // namespace egocal::tools
