// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "egocal/calibrate.hpp"
#include "egocal/online/nominal_part.hpp"

namespace egocal::tools {

/// How a pair is calibrated.
using Calibrate = std::function<Calibration(const CalibrationOptions&)>;

/// The calibration of a pair with a nominal value of which only a part is known (NaN elsewhere): first
/// without it, then with the rest from that answer (completed_nominal()), which is put into the options.
/// Empty part: `calibrate` alone. note: where the part does not give all that the motions hide, and nothing
/// is taken from it.
Calibration with_nominal_part(const std::optional<Pose>& part, NominalOf of, CalibrationOptions& options,
                              const Calibrate& calibrate, std::string& note);

}  // namespace egocal::tools
