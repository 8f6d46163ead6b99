// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "figures/frame.hpp"

namespace egocal::tools {

/// Names of the series, where they hide the least; empty where none has a name.
std::string legend(const Plot& plot, const Frame& frame);

}  // namespace egocal::tools
