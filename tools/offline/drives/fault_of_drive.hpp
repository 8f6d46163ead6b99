// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "egocal/calibrate.hpp"
#include "offline/drives/append.hpp"

namespace egocal::tools {

/// What is wrong with one drive of several, as its own answer says: "Drive 3 (c.tum) differs: ...", with a
/// cure of that drive alone. Empty where its findings are uncertain and do not make it contradictory, or are
/// of a time within it: the answer to all drives has those.
std::optional<Finding> fault_of_drive(const Drives& drives, std::size_t drive, const Calibration& alone);

/// Why a drive is not usable by itself: "Drive 1 (a.tum) by itself: ...", for drives that are usable
/// together. The finding that the drive's verdict is about has this message; a time in it counts from that
/// drive's start.
struct OwnFault {
  std::string reason;
  std::optional<Finding> finding;  ///< empty: the verdict is about the fit
};
OwnFault own_fault_of_drive(const Drives& drives, std::size_t drive, const Calibration& alone);

}  // namespace egocal::tools
