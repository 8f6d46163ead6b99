// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "egocal/pairing/options.hpp"
#include "egocal/problem/cost.hpp"

namespace egocal {

/// How much two measurements of one quantity typically differ: constant + growing * size, estimated from the
/// newest of them.
struct TypicalDifference {
  struct Seen {
    double size = 0;        ///< the smaller of the two, for an outlier makes one of them large
    double difference = 0;  ///< absolute
  };
  std::deque<Seen> newest;
  double constant = 0;  ///< standard deviation at size 0, in the unit of the quantity
  double growing = 0;   ///< per unit of size
  double large = 0;     ///< mean size of the larger half
  double moving = 0;    ///< a size that the larger ones exceed (CongruenceOptions::first_estimate of them)
};

/// What is typical of a pair of sensors. Noise may be the same for every motion or grow with it, and a drive
/// may begin at rest.
struct CongruenceScale {
  TypicalDifference angle;   ///< of the screw angles [rad]
  TypicalDifference slide;   ///< of the slides along the screw axes, of motions that turn [m]
  TypicalDifference length;  ///< of the lengths [m]
  TypicalDifference
      lever;       ///< of the lengths again, by angle: turning sensors apart go different ways [m, rad]
  double arm = 0;  ///< difference of the lengths that turning explains, per angle [m/rad]
  std::uint64_t remembered = 0;  ///< motions that were added
  std::uint64_t doubtful = 0;    ///< motions of doubtful poses, whether remembered or not
};

/// How two sensors' measurements of one motion differ.
struct MotionDifference {
  TypicalDifference::Seen angle, slide, length;
  bool turns = false;  ///< enough for the axis, along which it slides, to be known
};
MotionDifference difference_of(const DualQuaternion& a, const DualQuaternion& b,
                               const CongruenceOptions& options);

/// Whether enough motions were remembered for an estimate.
bool knows_typical(const CongruenceScale& scale, const CongruenceOptions& options);

/// Screw congruence: the motions of rigidly mounted sensors turn by the same angle and slide by the same
/// length, for every extrinsic. How far two motions over the same time, this number of steps, are from that,
/// in standard deviations of the typical difference of one step; 0 before the first estimate.
double incongruence(const MotionDifference& difference, double steps, const CongruenceScale& scale,
                    const CongruenceOptions& options);

/// Whether motions over this number of steps differ by more than noise ever does, however large it is just
/// now: by the size of the motions.
bool grossly_incongruent(const MotionDifference& difference, double steps, const CongruenceScale& scale,
                         const CongruenceOptions& options);

/// Which motion pairs are not congruent, compared with what is typical of the `memory` motions around each:
/// without poses, nothing else can confirm them. In three dimensions, in any order.
std::vector<bool> incongruent(std::span<const MotionPair> pairs, const ScreeningOptions& options = {});

/// Remembers the motion and estimates again where that is due. doubtful: the motion of a doubtful pose.
void update_congruence(const MotionDifference& difference, bool doubtful, CongruenceScale& scale,
                       const CongruenceOptions& options);

}  // namespace egocal
