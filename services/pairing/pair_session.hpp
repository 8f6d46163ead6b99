// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/decode.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/bus/scale.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/pairing/stream.hpp"
#include "egocal/scale/scale_drive.hpp"

namespace egocal::services {

struct EarlyPose {
  Side side = Side::a;
  StampedPose pose;
};

/// What one sensor pair has accumulated.
struct PairState {
  PairingState drive;
  std::optional<ScaleDriveState> scale;  ///< instead, where a sensor's scale is to be found
  std::int64_t session = -1;             ///< -1: none has begun
  std::int64_t last_session = -1;
  std::int64_t seq = 0;
  /// The stream that restarted first, until both streams have poses at common times. It keeps its first poses
  /// when the other stream restarts after it.
  std::optional<Side> restarted_by;
  std::vector<EarlyPose> early;
  bool paused = false;
};

/// A motion pair on its way to the bus.
struct MotionOut {
  std::size_t pair = 0;  ///< in the rig
  motion_pair_t message{};
};

/// One sensor pair: its sessions, and what is known about them.
class PairSession {
 public:
  PairSession(const bus::Rig& rig, std::size_t index);

  const bus::PairConfig& config() const { return config_; }
  std::int64_t session() const { return state_.session; }

  void push(Side side, const NumberedPose& sample, std::vector<MotionOut>& out);
  /// Pairs the poses that were held back while the clocks were compared: no pose comes for a while, and at
  /// the end of a log none ever would. What later poses give stays the same.
  void release_held(std::vector<MotionOut>& out);
  /// Whether there are poses that release_held() would pair.
  bool can_release() const { return state_.session >= 0 && !paused() && pairing().can_release(); }
  /// Why poses that have come gave no motion: the clocks are not compared yet. One line; empty otherwise.
  std::string without_clock() const;
  /// Lets the next pose begin a new session.
  void reset();
  void pause(bool paused) { state_.paused = paused; }
  bool paused() const { return state_.paused; }

  /// Whether something new is in the problem since the last message().
  bool fresh() const { return fresh_; }
  /// Whether message() will first choose the weights of a short drive, which takes about 2 ms.
  bool costs_a_choice() const { return has_problem() && !scale_ && drive_.costs_a_choice(); }
  /// The current problem, without the host of the sender; empty: there is none yet.
  std::optional<problem_t> message();
  /// The current problem of the unknown scale; empty: no scale is to be found, or there are no motions yet.
  std::optional<scale_problem_t> scale_message() const;
  /// Adds the counts of this pair to the counters of a status. As many statuses as senders need are sent, so
  /// this chooses no weights (MotionPairing::running_counts).
  void count(std::map<std::string, std::int64_t>& counters) const;

  PairState state() const;
  void restore(PairState state);

 private:
  void begin(std::int64_t time_us);
  void timeline_restarts(Side side);
  void accumulate(Side side, const StampedPose& pose, std::vector<MotionOut>& out);
  void begin_drive();
  void hand_out(const std::vector<MotionPair>& pairs, std::vector<MotionOut>& out);
  std::vector<MotionPair> push_pose(Side side, const StampedPose& pose);
  /// Poses, clock and synchronisation, whatever is made of them.
  const MotionPairing& pairing() const { return scale_ ? scale_->pairing() : drive_; }
  bool has_problem() const { return state_.session >= 0 && state_.seq > 0; }
  PairingCounts counts() const { return scale_ ? scale_->counts() : drive_.counts(); }

  std::size_t index_;
  bus::PairConfig config_;
  PairingOptions options_;
  std::optional<Side> unscaled_;
  MotionPairing drive_;
  std::optional<ScaleDrive> scale_;  ///< instead of drive_, where a sensor's scale is to be found
  PairState state_;                  // without the drive's
  bool fresh_ = false;
  std::int64_t received_mono_us_ = 0;
};

}  // namespace egocal::services
