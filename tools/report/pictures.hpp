// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "report/html.hpp"

namespace egocal::tools {

/// The figures of the page. One that would be empty is omitted, and a line says which and why.
std::string pictures(const ReportInput& input);

}  // namespace egocal::tools
