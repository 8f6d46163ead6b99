// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/samples/calibrate_samples.hpp"

namespace egocal::tools {

/// What a set of still poses has of its own.
struct SamplesOfPage {
  std::string text;                       ///< what `egocal solve` prints: samples_text()
  std::vector<SampleResidual> residuals;  ///< per sample
  std::vector<std::size_t> rows;          ///< of each sample in the file of a, from 0
};

/// What a report is made of.
struct ReportInput {
  std::string name_a, name_b;     ///< files, topics or channels
  Trajectory a, b;                ///< empty for a file of motion pairs
  std::vector<MotionPair> pairs;  ///< of motions as long as those that the fit is stated of
  CalibrationOptions options;
  Calibration calibration;
  std::optional<SamplesOfPage> samples;  ///< of still poses; a, b and pairs are empty then
  std::string method;
  std::string verdict;                ///< headline: the word of the verdict, a colon, the reason
  std::vector<std::string> warnings;  ///< about what was read
  bool eye_to_hand = false;           ///< of samples: the camera stands beside the arm
  std::string scale_course;           ///< how the scale changes along the drive; empty: it does not
  std::string clocks;                 ///< of each drive, where drives have clocks of their own; empty: one
  std::string unit = "m";             ///< of lengths: "m", or "unit of b"
  std::string command;                ///< the command line
  std::optional<Pose> truth;
};

/// One self-contained page: no script, no other file, pictures inside. The same input gives the same bytes.
std::string report_html(const ReportInput& input);

}  // namespace egocal::tools
