// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "offline/rig/calibration.hpp"

namespace egocal::tools {

/// The keys of docs/json.md, "solve A B C".
nlohmann::ordered_json rig_json(const RigReport& report);
std::string rig_text(const RigReport& report);

/// Why the answer of a rig should not be used, one sentence; only for an answer that should not.
std::string contradiction(const RigReport& report);

/// Remarks on the tree (tree_of()) for standard error, one line each.
std::vector<std::string> tree_remarks(const RigReport& report);

}  // namespace egocal::tools
