// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "egocal/samples/calibrate_samples.hpp"

namespace egocal::detail {

/// Samples that share one pose of a, or one of b, to rounding are one unit: several images at one pose of the
/// arm share its error, so they say less than as many samples, and rows that are repeated say nothing new.
/// Per sample the number of its unit, counted from 0 in the order of the samples. length: that makes
/// rotations and translations comparable [m].
std::vector<std::size_t> units_of(std::span<const PoseSample> samples, double length);

}  // namespace egocal::detail
