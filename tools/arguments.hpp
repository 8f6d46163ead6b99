// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "egocal/cli/cli.hpp"
#include "egocal/diagnosis/verdict.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/limits.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::tools {

using cli::UsageError;

/// Exactly `count` finite numbers. Throws UsageError naming the option.
std::vector<double> numbers(const std::string& option, const std::string& text, std::size_t count,
                            char separator = ',');
double number(const std::string& option, const std::string& text);
/// The same within a range.
double number_in(const std::string& option, const std::string& text, const Range& range);
/// X,Y,Z,QW,QX,QY,QZ.
Pose pose(const std::string& option, const std::string& text);
/// X,Y,Z,QW,QX,QY,QZ or X,Y,Z, with nan for what is not known: then NaN, all of the rotation or nothing of
/// it.
Pose nominal(const std::string& option, const std::string& text);
/// NX,NY,NZ,D: normal . x = D, the unit normal up.
GroundPlane plane(const std::string& option, const std::string& text);
/// ROTATION,TRANSLATION with units, as 0.1deg,2cm (deg or rad; mm, cm or m).
GoalOptions goal(const std::string& option, const std::string& text);
/// R:T.
Balance balance(const std::string& option, const std::string& text);

}  // namespace egocal::tools
