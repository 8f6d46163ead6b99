// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/io/extrinsic_text.hpp"

namespace egocal::tools {

/// A calibration as a file for another program, but for a scale.
NamedExtrinsic named_extrinsic(std::string parent, std::string child, const Calibration& calibration);

/// What whoever writes this extrinsic must know, one line each, for standard error: a verdict that is not
/// good and a goal that is missed, directions that are not of the motions, and a scale. Empty: nothing.
std::vector<std::string> remarks(const NamedExtrinsic& extrinsic, const Calibration& calibration);

}  // namespace egocal::tools
