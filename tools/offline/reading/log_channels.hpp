// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/bus/rig.hpp"

namespace egocal::tools {

/// Throws Error where a log holds no pair of the rig: its sensors' channels are not there, or hold messages
/// of another type than the rig says. Reads no further than to the first message of each channel that it
/// needs. The text names the first channel that is missing and channels that are there.
void require_a_pair(const std::string& log, const bus::Rig& rig);

}  // namespace egocal::tools
