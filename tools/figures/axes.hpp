// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "figures/frame.hpp"

namespace egocal::tools {

/// Grid, ticks, labels of the axes and title.
std::string axes(const Plot& plot, const Frame& frame);

}  // namespace egocal::tools
