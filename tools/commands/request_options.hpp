// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "commands/reading_options.hpp"
#include "egocal/cli/cli.hpp"
#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// What a command can solve.
enum class Sources {
  all,
  two_trajectories,  ///< no --pairs, --append and --samples
};

/// Which motions to solve and how, as typed; empty means not given. What `egocal solve` and `egocal report`
/// share.
struct RequestOptions {
  MotionSource source;
  ReadingOptions reading;
  std::string method = "global";
  bool planar = false;
  std::string plane_a, plane_b, stride, weights = "auto", time_offset, truth, nominal;
  std::string scale, scale_a, scale_b;  ///< --scale is that of A, as --scale-a says
  double max_gap = 0.5;
  std::string order_a, order_b, goal;
  bool invert_a = false, invert_b = false;
  bool samples = false, eye_in_hand = false, eye_to_hand = false;
  Sources sources = Sources::all;   ///< that the command takes
  std::vector<std::string> append;  ///< further drives: files of A and B alternately
};

/// Adds A, B and the options of the struct for these sources. It must exist until the command has run.
void add_request_options(cli::App command, RequestOptions& options, Sources sources = Sources::all);

/// Throws UsageError naming the option that cannot be understood.
SolveRequest understood(const RequestOptions& options);

}  // namespace egocal::tools
