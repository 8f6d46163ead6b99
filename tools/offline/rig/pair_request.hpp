// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/bus/rig.hpp"
#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// The calibration of one pair of a rig from a log, with all that the rig states of the pair. Throws Error as
/// bus::drive_options() does.
SolveRequest request_of_pair(const bus::Rig& rig, const bus::PairConfig& pair, const std::string& log);

}  // namespace egocal::tools
