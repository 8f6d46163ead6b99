// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/motions/instant.hpp"

namespace egocal::detail {

/// Motions of both sensors from one instant to another.
struct MotionsOfBoth {
  DualQuaternion a, b;
};

/// The same bits as motion_between() of a and of b, at half the cost.
MotionsOfBoth motions_between(const Instant& from, const Instant& to);

}  // namespace egocal::detail
