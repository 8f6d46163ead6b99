// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal {

/// Error (32): the size of the displacement between the truth and an estimate, both unit dual quaternions of
/// either sign.
struct ExtrinsicError {
  double translation = 0;  ///< [m]
  double rotation = 0;     ///< [0, pi] [rad]
};
/// The error of an estimate. Exact for small errors. Thread-safe.
ExtrinsicError extrinsic_error(const DualQuaternion& truth, const DualQuaternion& estimate);

}  // namespace egocal
