// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/command_t.hpp"
#include "player/console.hpp"
#include "player/control.hpp"
#include "player/in_flight.hpp"
#include "player/pace_options.hpp"
#include "player/tape.hpp"
#include "player/terminal_keys.hpp"

namespace egocal::services {

struct PlayerOptions {
  std::string log;
  TapeOptions range;
  double speed = 1;     ///< times real time; 0: as fast as everybody keeps up
  bool loop = false;    ///< from the beginning again at the end
  bool paused = false;  ///< waits for "resume"
  PaceOptions pace{};
};

/// Plays a log on the bus. It keeps in step with pairing: at most a few dozen messages are in flight, and
/// those that pairing did not get, because they were lost or its process ended, are sent again.
class Player {
 public:
  /// Throws Error where there is nothing to play.
  Player(bus::Loop& loop, bus::Heartbeat& heartbeat, const PlayerOptions& options);
  /// Reports what could not be played, whatever ended the loop.
  void report();

 private:
  void hear(const status_t& status);
  void hear(const command_t& command);
  void take_keys();
  void obey(const Control& control);
  void seek(double seconds);
  void play();
  void wait_until(std::int64_t mono_us);
  void load();
  bool begin_again();
  void say_it_jumps();
  bool send(const bus::LogEvent& event);
  bool network_may_return();
  void send_again();
  void watch_over();
  void say_that_it_waits(std::int64_t now);
  void finish();
  std::int64_t recorded_now() const;
  void anchor(std::int64_t recorded_us);
  double into_log(std::int64_t recorded_us) const;
  void show_progress(bool last);

  bus::Loop& loop_;
  bus::Heartbeat& heartbeat_;
  PlayerOptions options_;
  Tape tape_;
  InFlight in_flight_;
  Console console_;
  TerminalKeys terminal_keys_;
  Keys keys_;
  std::optional<bus::LogEvent> next_;
  std::int64_t played_us_ = 0;        ///< recorded time of the event that was sent last
  std::int64_t anchor_us_ = 0;        ///< recorded time that ...
  std::int64_t anchor_mono_us_ = 0;   ///< ... is played at this time of the clock
  std::int64_t started_mono_us_ = 0;  ///< with a network
  std::int64_t progress_mono_us_ = 0;
  std::int64_t pairing_mono_us_ = 0;              ///< when a status of pairing was heard last
  std::optional<std::int64_t> refused_mono_us_;   ///< since when the next message cannot be sent
  std::optional<std::int64_t> announced_gap_us_;  ///< recorded time at the end of the gap that was reported
  std::optional<bus::Loop::TimerId> timer_;
  bool paused_ = false, step_ = false, alone_ = false, waits_announced_ = false, ended_ = false;
  std::uint64_t out_ = 0;
};

}  // namespace egocal::services
