// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "egocal/bus/rig.hpp"
#include "egocal/diagnosis/verdict.hpp"

namespace egocal::services {

/// Words remedies for live use. The remedies of the library name options of the command line; here those that
/// the rig file can apply name its fields, and the others are for the sender of the stream.
void word_remedies(const bus::Rig& rig, const bus::PairConfig& pair, std::vector<Finding>& findings);

}  // namespace egocal::services
