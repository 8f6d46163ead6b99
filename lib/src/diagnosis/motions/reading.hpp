// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// A Reading with what has no cure on the command line: exchanged and mirrored columns.
struct PoseReading : Reading {
  Eigen::Matrix3d axes =
      Eigen::Matrix3d::Identity();  ///< applied to the position alone, a signed permutation
  bool conjugate = false;           ///< the rotation is that of the inverse pose
};

/// [m]: vector part of 2 dual conj(real).
Eigen::Vector3d position_of(const DualQuaternion& pose);

/// Whether it changes nothing: poses are what their file says.
bool as_given(const PoseReading& reading);

/// The pose that `given` is under this reading; a unit dual quaternion again.
DualQuaternion reread(const DualQuaternion& given, const PoseReading& reading);

}  // namespace egocal::detail
