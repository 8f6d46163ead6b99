// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "egocal/online/answer.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/pairing/time_offset.hpp"

namespace egocal::tools {

/// Where the motions come from: two trajectory files, two channels of an LCM log, or a file of motion pairs.
struct MotionSource {
  std::string a, b;              ///< files; with log: names of channels
  std::string times_a, times_b;  ///< for KITTI files
  std::string log;
  std::string pairs;
};

struct CalibrationOptions {
  MotionSource source;
  std::string method = "global";  ///< global fast dual sdp sqp slsqp, or a baseline: analytic matrix local
  PairingOptions drive;           ///< stride, balance: empty means auto
  bool estimate_time_offset = false;
  std::optional<Pose> truth;
};

/// Times of one stream, for people who wonder why nothing matched.
struct StreamSpan {
  std::size_t poses = 0;
  double first = 0, last = 0;  ///< [s]
};

struct CalibrationResult {
  Answer answer;
  std::string method;  ///< that answered, with the planar closed form as "planar"
  std::string note;    ///< of a baseline: why its answer is not valid
  Problem problem;
  Choice choice;
  PairingCounts counts;
  std::optional<StreamSpan> a, b;  ///< not for a file of pairs
  std::optional<TimeOffset> time_offset;
  double time_offset_applied = 0;  ///< [s]
  double solve_us = 0;             ///< the solve alone, median of repeats [us]
};

/// From the source to the answer. Throws Error where nothing can be read or paired, UsageError where options
/// contradict.
CalibrationResult calibrate_offline(const CalibrationOptions& options);

}  // namespace egocal::tools
