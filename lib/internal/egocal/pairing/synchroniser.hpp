// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "egocal/motions/instant.hpp"
#include "egocal/pairing/options.hpp"
#include "egocal/pairing/outcome.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal {

/// From one key to the next: what is typical shows which poses are off their path.
struct KeyStep {
  double length = 0;  ///< [m]
  double angle = 0;   ///< [rad]
};

/// All that a Synchroniser remembers. Bounded; continuing from a copy gives the same bits.
struct SynchroniserState {
  std::array<std::optional<std::int64_t>, 2> newest_us;  ///< of each stream
  std::array<std::deque<StampedPose>, 2> waiting;  ///< not yet synchronised; the faster one keeps neighbours
  std::optional<Side> keys;    ///< the slower stream, at whose stamps poses are paired; empty until known
  std::int64_t period_us = 0;  ///< typical, of the slower stream; 0 until known
  std::optional<std::int64_t> last_key_us;  ///< newest stamp that was paired or given up
  std::optional<StampedPose> previous_key;  ///< the pose with it, within a chain
  std::deque<KeyStep> key_steps;            ///< the last ones, up to keys that no other pose has the stamp of
  std::uint64_t synchronised = 0;           ///< instants
  std::uint64_t chain = 0;                  ///< of the instants: clocks so far
  Rejections rejections;                    ///< out of order, no partner, gap
};

/// Two streams of poses in, instants out: the faster stream is interpolated at the stamps of the slower one,
/// smoothly through several poses on both sides (detail::interpolate_smoothly()), once they are there. Where
/// its path is not smooth it is interpolated along a screw, and the pose of the slower stream is cut alike
/// (detail::cut_alike()), once its next one is there.
/// The result depends on the poses of each stream alone, not on how the two interleave.
class Synchroniser {
 public:
  /// Uses max_gap and the options of its own stage.
  explicit Synchroniser(const PairingOptions& options);
  Synchroniser(const PairingOptions& options, SynchroniserState state);

  /// Takes the next pose of one stream: unit, on the common clock. Returns the instants that it completed.
  std::vector<Instant> push(Side side, const StampedPose& pose);
  /// No more poses will come: synchronises what a drive too short to show its slower stream has held back. A
  /// last key that waits for the next one stays without a partner, so that this drive and one that is still
  /// running have the same instants.
  std::vector<Instant> finish();

  /// The next poses are on another clock: what waits is synchronised or rejected, and a new chain begins.
  std::vector<Instant> begin_chain();

  /// Typical time between two instants [us]; 0 until the slower stream is known.
  std::int64_t period_us() const { return state_.period_us; }
  const SynchroniserState& state() const { return state_; }

 private:
  void decide_keys();
  void remember_step(const StampedPose& key);
  std::vector<Instant> synchronise();

  SynchroniserOptions options_;
  std::int64_t max_gap_us_ = 0;
  SynchroniserState state_;
};

}  // namespace egocal
