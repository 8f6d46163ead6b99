// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/cost.hpp"

namespace egocal {

struct InterpolationLossOptions {
  double motion = 1;       ///< length of the motions that lose [s]; as ScaleDriveOptions::motion
  std::size_t starts = 4;  ///< that begin within the length of one
  bool cut_alike = true;   ///< as SynchroniserOptions::cut_alike
  /// Part that is left, where both streams are cut alike (detail::cut_alike()), of what a motion loses when
  /// its ends are interpolated over two periods: the fourth derivative of the path. Measured at rates of 4 to
  /// 20 Hz: 0.01 to 0.025 (docs/scale.md, "Interpolation").
  double share = 0.03;
  /// The same where they are not cut alike: a sixth is lost over one period at a random phase where the path
  /// is smooth, 1 - sinc^2(w P / 2) of 1 - cos(w P). Measured: 0 to 0.19.
  double share_not_cut = 0.2;
  /// Stamps of each stream that are kept until both streams have passed them; as
  /// SynchroniserOptions::most_waiting.
  std::size_t most_stamps = 4096;
};

/// All that an InterpolationLoss remembers. Bounded; continuing from a copy gives the same bits.
struct InterpolationLossState {
  struct Open {
    DualQuaternion motion;                           ///< since its begin
    Eigen::Vector3d miss = Eigen::Vector3d::Zero();  ///< of the interpolated begin [m]
    std::int64_t begin_us = 0;
  };
  std::array<std::deque<std::int64_t>, 2> stamps;  ///< of each stream, newer than the newest instant
  std::optional<MotionPair> previous;              ///< the step before the next one
  std::vector<Open> open;                          ///< motions that are still too short, oldest first
  double lost = 0, energy = 0;  ///< sums over motions: of their product with what they lose, of squares [m^2]
  std::uint64_t steps = 0;      ///< between instants
  std::uint64_t together = 0;   ///< of them end at a stamp of both streams: nothing is interpolated
  std::uint64_t passed = 0;     ///< stamps of the interpolated stream
};

/// How much of the lengths of a stream its interpolation takes off, as the other stream shows it: where its
/// poses are interpolated from their neighbours, over two periods, its motions become shorter by an amount
/// that is known. Depends on the poses of each stream alone, not on how the two interleave.
class InterpolationLoss {
 public:
  explicit InterpolationLoss(const InterpolationLossOptions& options);
  InterpolationLoss(const InterpolationLossOptions& options, InterpolationLossState state);

  /// The stamp of a pose [us], on the clock of a. Not called where that clock is not known: then all instants
  /// count as interpolated, over the period of the slower stream.
  void stamp(Side side, std::int64_t time_us);
  /// Motions between two instants. keys: the stream that is not interpolated.
  void step(const MotionPair& step, Side keys);

  /// Part of the length that the interpolated stream has lost, about; 0 where nothing is known.
  double part() const;
  const InterpolationLossState& state() const { return state_; }

 private:
  void count(const MotionPair& step, Side keys);

  InterpolationLossOptions options_;
  InterpolationLossState state_;
};

}  // namespace egocal
