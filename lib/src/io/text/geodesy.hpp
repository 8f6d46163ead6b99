// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/geometry/pose.hpp"

namespace egocal::detail {

/// A place on the ellipsoid WGS 84: latitude and longitude [rad], height above it [m].
struct GeodeticPosition {
  double latitude = 0, longitude = 0, height = 0;
};

/// Pose of the local frame east, north, up at a place, in the earth-centred frame. Place and axes.
Pose east_north_up(const GeodeticPosition& place);

}  // namespace egocal::detail
