// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "egocal/calibrate.hpp"

namespace egocal::tools {

/// The median of a duration that is measured again and again, for a tenth of a second or at least five times.
double median_us(const std::function<double()>& measure_us);

/// The median time that this solver takes for the problem, without proof and observability [us].
double time_of_method(Method method, const Problem& problem);

}  // namespace egocal::tools
