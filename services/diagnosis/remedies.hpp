// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "egocal/bus/rig.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal::services {

/// The library's remedies are options of the command line. Live, what can be cured in the rig file is worded
/// as its fields, the rest is for the sender.
void word_remedies(const bus::Rig& rig, const bus::PairConfig& pair, std::vector<Finding>& findings);

}  // namespace egocal::services
