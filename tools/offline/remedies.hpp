// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/calibrate.hpp"

namespace egocal::tools {

/// The findings speak of the streams as they were paired. Where that is by an option, the cure is to leave it
/// out, not to give it a second time: rewords findings and the reason of the verdict.
void word_for_options(const CalibrationOptions& options, Calibration& calibration);
/// The same for still poses with --eye-to-hand.
void word_for_eye_to_hand(Calibration& calibration);

/// Advice for a command that has no options of `egocal solve` but those for reading: "--time-offset auto" is
/// "egocal solve A B --time-offset auto".
std::string advice_of_solve(std::string advice);

}  // namespace egocal::tools
