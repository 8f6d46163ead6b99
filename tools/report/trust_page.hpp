// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/calibrate.hpp"

namespace egocal::tools {

/// Findings with their cures, uncertain ones marked as possible, then fit and goal: in the words of
/// `egocal solve`.
std::string trust_page(const Calibration& calibration);
/// Lines of the terminal, a label of 14 cells and a value each, as a table.
std::string table_of_lines(const std::string& text);

}  // namespace egocal::tools
