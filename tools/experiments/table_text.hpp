// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiments/comparison.hpp"

/// A comparison of methods in other forms than that for people (comparison.hpp), each the whole text of a
/// file.
namespace egocal::tools {

/// method,mode,error_translation_m,error_rotation_deg,milliseconds,verdict; errors are empty where the truth
/// is not known.
std::string csv(const std::vector<ComparisonRow>& rows);

/// A tabular in the shape of Table II: errors in cm and degrees, times in ms. Needs no package.
std::string latex(const std::vector<ComparisonRow>& rows);

}  // namespace egocal::tools
