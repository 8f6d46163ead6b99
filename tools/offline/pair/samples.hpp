// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// Reads still poses and solves them. Throws Error naming the files.
void answer_samples(const SolveRequest& request, SolveResult& result);

/// The rows of a sample in both files, from 1: "7", or "7 (6 of b)".
std::string rows_in_words(const MatchedSamples& matched, std::size_t sample);

}  // namespace egocal::tools
