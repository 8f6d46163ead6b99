// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "offline/pair/calibration.hpp"

/// How a JSON output was made (docs/json.md).
namespace egocal::tools {

/// Number of the description of our JSON. Raised when a key is removed or changes its meaning.
constexpr int json_schema = 1;

/// `schema`, `version` and `command`.
nlohmann::ordered_json provenance_json(const std::string& command_line);

/// A list of {`role`, `name`}; files without a name are not listed. Text that is no UTF-8 is made printable.
nlohmann::ordered_json files_json(const std::vector<std::pair<std::string, std::string>>& role_and_name);
nlohmann::ordered_json files_json(const SolveRequest& request);

/// Settings in force, defaults included: an object.
nlohmann::ordered_json settings_json(const SolveRequest& request);

/// Appends the members of `more`; those of `json` keep their values.
void append_json(nlohmann::ordered_json& json, const nlohmann::ordered_json& more);

}  // namespace egocal::tools
