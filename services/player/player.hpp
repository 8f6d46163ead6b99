// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <regex>
#include <string>

#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/command_t.hpp"
#include "player/in_flight.hpp"

namespace egocal::services {

struct PlayerOptions {
  std::string log;
  double speed = 1;           ///< times real time; 0: as fast as everybody keeps up
  bool loop = false;          ///< from the beginning again at the end
  bool paused = false;        ///< waits for "resume"
  double start = 0;           ///< begins so far into the log [s]
  std::optional<double> end;  ///< ends so far into the log [s]
  std::string channel;        ///< regular expression; empty: all
};

/// Plays a log on the bus. In step with pairing: no more than a few dozen messages are on their way to it at
/// any time, and what it did not get, because it was lost or its process died, is sent again.
class Player {
 public:
  Player(bus::Loop& loop, bus::Heartbeat& heartbeat, const PlayerOptions& options);

 private:
  void hear(const status_t& status);
  void hear(const command_t& command);
  void take_line();
  void play();
  bool load();
  void send(const bus::LogEvent& event);
  void send_again();
  void watch_over();
  void finish();
  void seek(double seconds);
  void anchor();
  void show_progress(bool last);

  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  PlayerOptions options_;
  bus::LogReader log_;
  std::optional<std::regex> channel_;
  InFlight in_flight_;
  std::optional<bus::LogEvent> next_;
  std::int64_t begin_us_ = 0;        ///< recorded time of the first event
  std::int64_t anchor_us_ = 0;       ///< recorded time that ...
  std::int64_t anchor_mono_us_ = 0;  ///< ... is played at this time of the clock
  std::int64_t started_mono_us_ = 0, progress_mono_us_ = 0, shown_mono_us_ = 0;
  std::optional<bus::Loop::TimerId> timer_;
  bool paused_ = false, step_ = false, alone_ = false, ended_ = false, terminal_ = false;
  std::uint64_t out_ = 0;
};

}  // namespace egocal::services
