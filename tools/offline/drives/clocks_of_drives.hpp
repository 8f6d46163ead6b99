// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Recorders are started anew for each drive, and with them the clocks of the sensors: one time offset for all
// drives would be none of theirs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "offline/drives/append.hpp"

namespace egocal::tools {

/// The clock of b in one drive of several.
struct ClockOfDrive {
  std::string name;     ///< of the drive: the file of its first sensor
  TimeOffset estimate;  ///< from this drive alone, corrected
};

/// Estimates the time offset of each drive from that drive alone. Where two of them differ for certain,
/// compared with their standard deviations as a live clock is (PairingOptions::clock), the part of each drive
/// in b is put on the clock of a, and the clocks are handed back, one for each drive. Otherwise b is
/// unchanged and the list is empty: one estimate serves all of them. Throws Error where the clocks of two
/// drives differ and that of another cannot be estimated or is not certain, as where its motion repeats. a,
/// b: the streams of the sensors as they were read; options: how they are read and paired.
std::vector<ClockOfDrive> put_drives_on_clock_of_a(const Drives& drives, std::size_t sensor_a,
                                                   std::size_t sensor_b, const Trajectory& a, Trajectory& b,
                                                   const CalibrationOptions& options);

/// "-0.3003 s (a.tum), 0.0001 s (b.tum) added to its stamps".
std::string clocks_in_words(const std::vector<ClockOfDrive>& clocks);

}  // namespace egocal::tools
