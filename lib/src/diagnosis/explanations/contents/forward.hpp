// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "diagnosis/motions/motions.hpp"

namespace egocal::detail {

/// In which direction of their own bodies the sensors travel.
struct Heading {
  double concentration_a = 0, concentration_b = 0;  ///< length of the mean direction: 1 always the same
  double line_a = 0, line_b = 0;  ///< mean squared cosine with the usual line: 1 always forwards or backwards
  double way_a = 0, way_b = 0;    ///< length of all motions [m]
  double turned = 0;              ///< angle in all, of all motions [rad]
};

Heading heading(const Motions& motions);

/// Whether this is a vehicle: both sensors always travel the same way of their bodies.
bool forward(const Heading& heading, const HeadingOptions& options);
/// Whether this is a vehicle that reverses as well: both sensors always travel along the same line of their
/// bodies.
bool along_one_line(const Heading& heading, const HeadingOptions& options);
/// Whether neither sensor mostly travels the same way of its body.
bool scattered(const Heading& heading, const HeadingOptions& options);

/// Whether both bodies go a longer way under the reading x of their poses than under y, by their sensors and
/// by their stillest points. Of a trajectory and its inverse the right one is the shorter: seen from a body
/// that turns, the world travels, and faster the further away it is.
bool longer_way(const Motions& x, const Motions& y);

}  // namespace egocal::detail
