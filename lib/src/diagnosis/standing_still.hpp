// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "diagnosis/motions.hpp"

namespace egocal::detail {

/// What counts as a recording without motion. Less of it shows no extrinsic to a degree or to decimetres,
/// with whatever odometry.
struct StandingStillOptions {
  double rotation = 0.03;         ///< between poses far apart in time, at most [rad]
  double translation = 0.3;       ///< the same [m]
  double part = 0.9;              ///< of the pairs of poses; wrong poses make up the others
  std::size_t most_pairs = 1000;  ///< that are looked at: a limit on time
};

/// Whether neither sensor moves: all that their motions show is noise, which contradicts every extrinsic.
bool standing_still(const Instants& instants, const StandingStillOptions& options = {});

}  // namespace egocal::detail
