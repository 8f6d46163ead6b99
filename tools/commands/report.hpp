// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "offline/pair/calibration.hpp"
#include "report/html.hpp"

namespace egocal::tools {

/// Solves and writes the page; `command` is shown on it. Throws Error as calibrate_offline() does.
ReportInput write_report(SolveRequest request, const std::string& out, const std::string& command);

}  // namespace egocal::tools
