// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Findings in words: what was found, and what to do about it.
#pragma once

#include <string>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal::detail {

Finding worded_reading(Finding finding, const PoseReading& read_a, const PoseReading& read_b);
/// either: of "units", whichever stream may be in the wrong one.
Finding worded_scale(Finding finding, bool either = false);
Finding worded_clock(Finding finding, const ClockModel& clock);

Finding certain_finding(const char* code, std::string message, std::string remedy);

/// "67.8 cm", and from ten metres on "12.3 m"; three digits. Of a unit that is not metres: "67.8 units".
std::string length_in_words(double length, bool metres = true);

/// "(0.84, -0.38, 0.39)", without "-0.00".
std::string axis_in_words(const Eigen::Vector3d& axis);

/// The mark of a stream ('a' or 'b') in a sentence of a finding (finding_words.hpp).
const char* mark(char stream);

/// printf into a string of at most 511 characters.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

}  // namespace egocal::detail
