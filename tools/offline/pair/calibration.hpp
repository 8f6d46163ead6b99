// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/io/recording.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "egocal/scale/scale_course.hpp"
#include "offline/drives/clocks_of_drives.hpp"

namespace egocal::tools {

/// Where the motions come from: two trajectory files, two channels of an LCM log, or a file of motion pairs.
struct MotionSource {
  std::string a, b;  ///< files; with log: names of channels
  std::string log;
  std::string pairs;
  ReadOptions reading_a, reading_b;
};

/// What only sets of still poses need.
struct SamplesRequest {
  bool eye_to_hand = false;  ///< the camera stands beside the arm: the poses of a are inverted
};

/// What `egocal solve` was asked for.
struct SolveRequest {
  MotionSource source;
  std::string method = "global";     ///< global fast dual sdp sqp slsqp, or a baseline: analytic matrix local
  CalibrationOptions calibration;    ///< its method is set from the name above
  std::optional<Pose> nominal_part;  ///< --nominal of which something is not known: NaN there
  std::vector<std::string> append;   ///< further drives of the same sensors: files of a and b alternately
  std::optional<Pose> truth;
  std::optional<SamplesRequest> samples;  ///< the files hold still poses, not streams
  bool keep_motions = false;              ///< hand back what was solved, for a report
  std::string scale_option;               ///< as it was typed: "--scale" names no side; empty: not given
  /// What is put before options of `egocal solve` in messages to the user; empty: they are options of this
  /// command.
  std::string solve;
  /// Called with the warnings where there is no answer that could hold them: they may say why.
  std::function<void(const std::vector<std::string>&)> unanswered;
};

/// Times of one stream, for people who wonder why nothing matched.
struct StreamSpan {
  std::size_t poses = 0;
  double first = 0, last = 0;  ///< [s]
};

/// A calibration with what only the command line adds.
struct SolveResult {
  Calibration calibration;
  std::string method;                 ///< that answered, with the planar closed form as "planar"
  std::vector<std::string> warnings;  ///< one line each: what the source holds and the answer does not use
  std::string note;                   ///< of a baseline: why its answer is not valid
  std::optional<StreamSpan> a, b;     ///< not for a file of pairs
  std::optional<ScaleCourse> course;  ///< where the estimated scale changes along the drive
  std::vector<ClockOfDrive> clocks;   ///< of each drive, where drives have clocks of their own
  double solve_us = 0;                ///< the solve alone, median of repeats [us]
  std::optional<SampleCalibration> samples;  ///< of still poses; its calibration is the one above
  MatchedSamples matched;                    ///< the rows that make them
  bool eye_to_hand = false;
  Side scale_side = Side::a;                    ///< whose translations a scale multiplies
  bool a_has_scale = true, b_has_scale = true;  ///< false: the format has lengths of no unit

  /// Only with keep_motions: with inversions, orders and the scale applied, on the clock of the files.
  Trajectory trajectory_a, trajectory_b;  ///< empty for a file of pairs
  std::vector<MotionPair> pairs;          ///< of the stride and the weights in force
  std::vector<MotionPair>
      fit_pairs;  ///< of motions as long as those that the fit is stated of; none rejected
};

/// Calibrates, from the source to the answer. Throws Error where nothing can be read or paired, UsageError
/// where options contradict each other.
SolveResult calibrate_offline(const SolveRequest& request);

}  // namespace egocal::tools
