// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "offline/calibration.hpp"

namespace egocal::tools {

/// The scale that was found or given, and how it changes along the drive. The JSON needs a scale that was
/// found.
nlohmann::ordered_json scale_json(const SolveResult& result);
/// Empty where lengths are as they were read.
std::string scale_text(const SolveResult& result);

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
