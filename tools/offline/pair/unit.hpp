// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// "a" or "b": whose lengths a scale multiplies, and the other one.
const char* scaled_name(const SolveResult& result);
const char* unscaled_name(const SolveResult& result);

/// Whether the lengths of the answer are metres, as far as that is known: with a scale that was found they
/// are in the unit of the sensor that is not scaled.
bool in_metres(const SolveResult& result);

/// The same before the answer, for its verdict: whoever names the sensor without scale says that the other
/// one measures metres. result: which formats have a scale, and whose lengths are multiplied.
LengthUnit unit_of_answer(const SolveRequest& request, const SolveResult& result);
/// "m", or "unit of b".
std::string unit_of_lengths(const SolveResult& result);
/// A line for people who read "cm" below; empty where lengths are metres.
std::string unit_text(const SolveResult& result);
/// One sentence where the other side was probably meant, with the option that says so; else empty.
std::string scale_warning(const SolveRequest& request, const SolveResult& result);

}  // namespace egocal::tools
