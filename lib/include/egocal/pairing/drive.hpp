// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal {

/// How motions are made from two streams of poses, and what the solvers are to minimise.
struct DriveOptions {
  Mode mode = Mode::spatial;
  GroundPlane plane_a, plane_b;      ///< planar mode
  std::optional<int> stride;         ///< steps of the slower stream in one motion; empty: chosen by the jack-knife
  std::optional<Balance> balance;    ///< empty: chosen by the jack-knife
  double time_offset = 0;            ///< added to the stamps of b before pairing [s]
  double max_gap = 0.5;              ///< poses further apart are never interpolated between [s]
  std::optional<DualQuaternion> prior;  ///< handed on to the problem
};

/// Why a pose or a motion is not in the statistics.
enum class Rejection {
  not_finite,         ///< NaN, infinity or a quaternion far from unit length
  out_of_order,       ///< not newer than the newest of its stream
  no_partner,         ///< the other stream has no pose on one side of it (before its start, after its end)
  gap,                ///< the neighbours in the other stream, or the two ends of the motion, are too far apart
  screw_congruence,   ///< the two motions differ in angle or slide by more than noise explains
  too_much_rotation,  ///< so near to half a turn that the sign of its quaternion is a guess
  count_
};
std::string_view name(Rejection reason);

struct DriveCounts {
  std::uint64_t poses_a = 0, poses_b = 0;  ///< handed in
  std::uint64_t synchronised = 0;          ///< instants for which both poses are known
  std::uint64_t matched = 0;               ///< motion pairs in the statistics (of the chosen stride)
  std::array<std::uint64_t, static_cast<std::size_t>(Rejection::count_)> rejected{};
};

/// The setting that is in force and why.
struct Choice {
  int stride = 1;
  Balance balance;
  std::string reason;  ///< "fixed", or the jack-knife's numbers in a short sentence
};

/// From two streams of poses to the problem, one pose at a time: synchronises by screw interpolation of the faster
/// stream at the stamps of the slower one, forms motions, gates them, accumulates them in blocks for every stride
/// under consideration, and chooses stride and balance. Used offline and by egocal-pairing alike; the result depends
/// on the poses of each stream alone, not on how the two streams interleave. Its memory is bounded.
class Drive {
 public:
  explicit Drive(DriveOptions options);

  /// Takes in the next pose of one stream. Returns the motion pairs of the chosen stride that it completed.
  std::vector<MotionPair> push(Side side, const StampedPose& pose);

  /// What is known so far.
  Problem problem() const;
  const Choice& choice() const { return choice_; }
  const DriveCounts& counts() const { return counts_; }
  const DriveOptions& options() const { return options_; }
  std::optional<std::int64_t> newest_us() const;  ///< end of the newest motion (time of a) [us]

 private:
  DriveOptions options_;
  Choice choice_;
  DriveCounts counts_;
};

}  // namespace egocal
