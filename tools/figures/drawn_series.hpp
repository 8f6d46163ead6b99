// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "figures/frame.hpp"

namespace egocal::tools {

/// The marks of a series in its style, with its band.
std::string drawn(const Series& series, const Plot& plot, const Frame& frame);

}  // namespace egocal::tools
