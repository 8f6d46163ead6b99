// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/geodesy.hpp"

#include <cmath>

namespace egocal::detail {

Pose east_north_up(const GeodeticPosition& place) {
  constexpr double a = 6378137.0;          // [m], WGS 84
  constexpr double f = 1 / 298.257223563;  // flattening
  constexpr double e2 = f * (2 - f);       // squared eccentricity
  const double sin_lat = std::sin(place.latitude), cos_lat = std::cos(place.latitude);
  const double sin_lon = std::sin(place.longitude), cos_lon = std::cos(place.longitude);
  const double n = a / std::sqrt(1 - e2 * sin_lat * sin_lat);  // radius of curvature in the prime vertical
  Eigen::Matrix3d axes;                                        // columns east, north, up
  axes << -sin_lon, -sin_lat * cos_lon, cos_lat * cos_lon,     //
      cos_lon, -sin_lat * sin_lon, cos_lat * sin_lon,          //
      0, cos_lat, sin_lat;
  const double r = (n + place.height) * cos_lat;
  return {Eigen::Quaterniond(axes).normalized(),
          {r * cos_lon, r * sin_lon, (n * (1 - e2) + place.height) * sin_lat}};
}

}  // namespace egocal::detail
