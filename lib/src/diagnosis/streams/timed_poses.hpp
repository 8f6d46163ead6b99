// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "diagnosis/motions/motions.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// A stream and its times since one origin [s]. The trajectory must still be there.
struct TimedPoses {
  const Trajectory& poses;
  Times times;
};

}  // namespace egocal::detail
