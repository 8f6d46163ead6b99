// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/calibrate.hpp"

namespace egocal::tools {

/// The findings speak of the streams as they were paired. Where that is by an option, the cure is to leave it
/// out, not to give it a second time: rewords findings and the reason of the verdict. scale_option: as it was
/// typed, --scale, --scale-a or --scale-b.
void word_for_options(const CalibrationOptions& options, const std::string& scale_option,
                      Calibration& calibration);
/// The same for still poses, which have options of their own.
void word_for_options_of_samples(const CalibrationOptions& options, const std::string& scale_option,
                                 bool eye_to_hand, Calibration& calibration);

}  // namespace egocal::tools
