// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/io/extrinsic_text.hpp"
#include "egocal/online/answer.hpp"

namespace egocal::bus {

/// What the numbers of an answer heard on the bus rest on, of x y z roll pitch yaw. planar: by its method, or
/// by the mode of its problem where that is known. In the plane a hint says that x, y or yaw are not shown
/// either; which is not sent.
std::array<Backing, 6> backing_of(const Observability& observability, bool planar, bool has_nominal);

}  // namespace egocal::bus
