// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "diagnosis/motions/motions.hpp"

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

/// What counts as a motion at rest, in a drive that moves otherwise. Half of the way is travelled in longer
/// motions than the usual one, and half of the turning in larger ones.
struct RestOptions {
  double length = 0.1;  ///< at most, as a part of the usual one
  double angle = 0.5;   ///< the same: a train turns by little more than its noise
  /// A motion at rest is also at most this many times the median residual of motions that are so short: what
  /// is slow and exact is no rest.
  double of_noise = 3;
  /// The motions at rest are omitted where they are at least this part: of less no median is one of noise.
  double least_part = 0.2;
};

/// The usual angle of motions [rad]: half of the turning is in motions that turn by more. The smaller angle
/// of both sensors counts, as wrong poses are large.
double usual_angle(const Motions& motions);

/// Which motions are those of sensors that stand, by their residuals at an extrinsic: noise, compared with
/// noise.
std::vector<bool> at_rest(const Motions& motions, const Pose& T_a_b, const RestOptions& options = {});

/// Which motions are at rest by one of the sensors at least: a wrong pose moves one stream alone.
std::vector<bool> one_at_rest(const Motions& motions, const RestOptions& options = {});

/// The motions without those at rest, measured by what they are without them; all of them where few are.
Motions without_rest(const Motions& motions, const Pose& T_a_b, const RestOptions& options = {});

}  // namespace egocal::detail
