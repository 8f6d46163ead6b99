// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What may be believed of values from outside, and how their texts are shown.
#pragma once

#include <cstddef>
#include <string>

#include "egocal/limits.hpp"
#include "egocal/printable.hpp"

namespace egocal::bus {

using egocal::plausible_time;

/// Letters, digits, _ and -, 1 to 40 of them: safe in channel names and on terminals.
bool plausible_name(const std::string& name);

/// Texts of messages: at most 1000 bytes.
bool plausible_text(const std::string& text);

using egocal::printable;

}  // namespace egocal::bus
