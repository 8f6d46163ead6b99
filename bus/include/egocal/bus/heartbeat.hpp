// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "egocal/acknowledgement_t.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/peers.hpp"

namespace egocal::bus {

struct Identity {
  std::string name;  ///< of the process, e.g. egocal-fast
  std::string role;  ///< player, pairing, global, fast, monitor
  std::string version;
};

/// Sends status_t once a second and on change (at most every 50 ms), and hears those of the others. A
/// namesake is answered at once, so that two processes of one name learn of each other within milliseconds.
class Heartbeat {
 public:
  Heartbeat(Loop& loop, Identity identity, std::chrono::nanoseconds timeout);
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;
  /// end(), without asking anybody for counters.
  ~Heartbeat();
  /// Says "ended", once.
  void end();

  const Identity& identity() const { return identity_; }
  std::int64_t run() const { return run_; }

  /// A count that goes out with every status; stays valid.
  std::int64_t& counter(const std::string& name) { return counters_[name]; }
  /// "rejected: <reason>", bounded in number: beyond 60 reasons they are counted as "rejected: other".
  void reject(const std::string& reason);

  void set_state(const std::string& state);
  const std::string& state() const { return state_; }
  /// Empty: no error any more.
  void set_error(const std::string& error);

  std::vector<acknowledgement_t>& acknowledgements() { return acknowledgements_; }

  /// Counters that somebody else keeps are brought up to date here, before a status goes out.
  void before_publish(std::function<void()> callback) { before_publish_ = std::move(callback); }
  /// Called for each status of another process.
  void on_status(std::function<void(const status_t&)> callback) { on_status_ = std::move(callback); }
  void publish();

  bool alive(const std::string& role) const;
  std::string role_of(const std::string& name) const { return peers_.role_of(name); }
  /// Another living process has this name and started earlier.
  std::optional<Peer> elder_namesake() const;

 private:
  void change();
  void hear(const status_t& status);

  Loop& loop_;
  Identity identity_;
  std::chrono::nanoseconds timeout_;
  std::string host_;
  std::int32_t pid_;
  std::int64_t run_;
  std::string state_ = "waiting";
  std::string error_;
  std::map<std::string, std::int64_t> counters_;
  std::vector<acknowledgement_t> acknowledgements_;
  Peers peers_;
  std::function<void()> before_publish_;
  std::function<void(const status_t&)> on_status_;
  std::chrono::steady_clock::time_point published_{};
  bool change_pending_ = false;
};

}  // namespace egocal::bus
