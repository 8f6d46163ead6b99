// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/units.hpp"

#include <algorithm>
#include <iterator>
#include <numbers>

namespace egocal::detail {

namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double foot = 0.3048, mile = 5280 * foot, nautical_mile = 1852;  // [m], by definition

/// names: the usual one first, between blanks.
struct Unit {
  Dimension dimension;
  double in_si;
  std::string_view names;
};

constexpr Unit units[] = {
    {Dimension::time, 1, "s sec secs second seconds"},
    {Dimension::time, 1e-3, "ms msec msecs millisecond milliseconds"},
    {Dimension::time, 1e-6, "us \xc2\xb5s \xce\xbcs usec usecs microsecond microseconds"},
    {Dimension::time, 1e-9, "ns nsec nsecs nanosec nanosecond nanoseconds"},
    {Dimension::length, 1, "m metre metres meter meters"},
    {Dimension::length, 1e-1, "dm decimetre decimetres decimeter decimeters"},
    {Dimension::length, 1e-2, "cm centimetre centimetres centimeter centimeters"},
    {Dimension::length, 1e-3, "mm millimetre millimetres millimeter millimeters"},
    {Dimension::length, 1e3, "km kilometre kilometres kilometer kilometers"},
    {Dimension::length, foot / 12, "in inch inches \""},
    {Dimension::length, foot, "ft foot feet '"},
    {Dimension::length, 1200.0 / 3937, "ftus usft us-ft ft-us ftus survey-ft"},
    {Dimension::length, 3 * foot, "yd yard yards"},
    {Dimension::length, mile, "mi mile miles"},
    {Dimension::length, nautical_mile, "nmi"},
    {Dimension::angle, 1, "rad radian radians"},
    {Dimension::angle, 1e-3, "mrad"},
    {Dimension::angle, turn / 360, "deg degree degrees \xc2\xb0 \xb0"},
    {Dimension::angle, turn / 21600, "arcmin"},
    {Dimension::angle, turn / 1296000, "arcsec"},
    {Dimension::angle, turn / 400, "gon grad"},
    {Dimension::angle, turn, "rev turn turns"},
    {Dimension::speed, 1, "m/s mps ms^-1 ms-1 m*s^-1 m.s-1"},
    {Dimension::speed, 1e-2, "cm/s"},
    {Dimension::speed, 1e-3, "mm/s"},
    {Dimension::speed, 1e3 / 3600, "km/h kmh kph kmph"},
    {Dimension::speed, foot, "ft/s fps"},
    {Dimension::speed, mile / 3600, "mph mi/h"},
    {Dimension::speed, nautical_mile / 3600, "kn kt kts knot knots"},
    {Dimension::turning, 1, "rad/s rads^-1 rads-1 rad*s^-1 rad.s-1 rps"},
    {Dimension::turning, 1e-3, "mrad/s"},
    {Dimension::turning, turn / 360, "deg/s dps degs^-1 degs-1 \xc2\xb0/s"},
    {Dimension::turning, turn / 60, "rpm"},
    // quaternions
    {Dimension::number, 1, "- 1 none unit unitless dimensionless normalized normalised"},
};

bool is_named(const Unit& unit, std::string_view name) {
  for (std::string_view names = unit.names; !names.empty();) {
    const std::size_t end = std::min(names.find(' '), names.size());
    if (names.substr(0, end) == name) return true;
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  return false;
}

}  // namespace

std::optional<double> in_si(Dimension dimension, std::string_view unit) {
  for (const Unit& known : units)
    if (known.dimension == dimension && is_named(known, unit)) return known.in_si;
  return std::nullopt;
}

std::string known_units(Dimension dimension) {
  std::string text;
  for (const Unit& known : units)
    if (known.dimension == dimension)
      text += (text.empty() ? "" : ", ") + std::string(known.names.substr(0, known.names.find(' ')));
  return text;
}

bool is_unit_word(std::string_view word) {
  constexpr std::string_view words[] = {
      "s",  "ms",  "us",      "ns",   "m",   "metres", "meters",  "dm",  "cm",  "mm",  "km",  "ft",  "feet",
      "yd", "rad", "radians", "mrad", "deg", "degree", "degrees", "mps", "kmh", "kph", "mph", "dps", "rpm"};
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

bool states_a_clock(std::string_view unit) {
  constexpr std::string_view clocks[] = {"utc",   "gps", "gnss",  "tai",  "unix", "posix",
                                         "epoch", "ros", "local", "wall", "iso",  "iso8601"};
  return std::find(std::begin(clocks), std::end(clocks), unit) != std::end(clocks) ||
         unit.find("yy") != std::string_view::npos || unit.find("hh") != std::string_view::npos;
}

}  // namespace egocal::detail
