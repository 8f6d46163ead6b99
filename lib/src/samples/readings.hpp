// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "egocal/samples/calibrate_samples.hpp"
#include "samples/agreeing.hpp"

namespace egocal::detail {

/// The samples as understood by the readings of the options, unit and with canonical signs.
std::vector<PoseSample> reread(std::span<const PoseSample> samples, const Reading& read_a,
                               const Reading& read_b);

/// Readings of the poses under which they fit far better than as given: one list inverted, another order of
/// the quaternion, another unit of length.
std::vector<Finding> find_other_readings(std::span<const PoseSample> samples, const AgreeingSamples& given,
                                         const SampleOptions& options);

}  // namespace egocal::detail
