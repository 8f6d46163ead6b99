// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// "1 pose", "2 poses".
std::string counted(std::uint64_t count, std::string_view noun);

/// "1200 poses from 1700000000.000 to 1700000119.900 s", "1 pose at 5.000 s", "no poses". Times in seconds.
std::string span_in_words(std::uint64_t poses, double first, double last);
std::string span_in_words(const Trajectory& trajectory);

/// "The motion repeats every 4 s: time offsets of camera that differ by that fit as well." Without a sensor:
/// of the two that the user knows.
std::string rival_offsets_in_words(double period, std::string_view sensor = "");

}  // namespace egocal
