// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/pairing/drive.hpp"
#include "pairing/stream.hpp"
#include "program/commands.hpp"

namespace egocal::services {

/// One sensor pair: its sessions, and what goes out about them.
class PairSession {
 public:
  PairSession(bus::Loop& loop, const bus::Rig& rig, const bus::PairConfig& config);

  const bus::PairConfig& config() const { return config_; }
  std::int64_t session() const { return session_; }

  void push(Side side, const Sample& sample);
  /// The next pose begins a new session.
  void reset();
  void pause(bool paused) { paused_ = paused; }
  bool paused() const { return paused_; }

  /// Sends the problem if it is new; repeat: also if it is not, for late listeners.
  void publish(bool repeat);
  void count(std::map<std::string, std::int64_t>& counters) const;

 private:
  struct EarlyPose {
    Side side;
    StampedPose pose;
  };
  void begin(std::int64_t time_us);
  void timeline_restarts(Side side);
  void accumulate(Side side, const StampedPose& pose);

  bus::Loop& loop_;
  bus::PairConfig config_;
  DriveOptions options_;
  std::string motion_channel_, problem_channel_, host_;
  Drive drive_;
  std::int64_t session_ = -1;  // -1: none has begun
  std::int64_t last_session_ = -1;
  std::int64_t seq_ = 0;
  // Until the two streams have met, so that the second one's restart does not cost the first one's poses.
  std::optional<Side> restarted_by_;
  std::vector<EarlyPose> early_;
  bool paused_ = false;
  bool fresh_ = false;
  std::int64_t sent_ = 0;  // problems
  std::int64_t received_mono_us_ = 0;
};

/// egocal-pairing: from the sensors' poses to problem_t.
class Pairing {
 public:
  Pairing(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig);

 private:
  struct Channel {
    Channel(const bus::Sensor& config, double reorder_window) : sensor(config), stream(reorder_window) {}
    bus::Sensor sensor;
    Stream stream;
    std::int64_t count = 0;  // taken in or rejected since the start of the process
    std::int64_t utime = 0;
    std::int64_t heard_mono_us = 0;
  };

  void take(Channel& channel, const bus::Arrival& arrival);
  void route(const Channel& channel, const std::vector<Sample>& samples);
  void after_batch(bool caught_up);
  void every_second();
  void obey(Verb verb, const command_t& command);
  void acknowledge();
  bool leads() const { return !waits_for_elder_; }

  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  std::vector<std::unique_ptr<Channel>> channels_;
  std::vector<std::unique_ptr<PairSession>> pairs_;
  int unacknowledged_ = 0;
  bool paused_ = false;
  bool waits_for_elder_ = false;
};

}  // namespace egocal::services
