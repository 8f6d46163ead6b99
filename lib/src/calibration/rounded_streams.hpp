// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How much two streams differ by the digits that their files have. Where the mounting exchanges axes exactly
// (a camera on a lidar), most numbers of both files are rounded alike: the differences between the streams
// then do not show how large the others may be, and the screening would take these for wrong poses.
#pragma once

#include "egocal/pairing/options.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// The options with a floor under the typical differences that is no lower than one standard deviation of
/// what the digits of both streams make of the angle and of the length of a motion. Streams with more digits
/// change nothing.
PairingOptions with_rounding(PairingOptions options, const Trajectory& a, const Trajectory& b);

}  // namespace egocal::detail
