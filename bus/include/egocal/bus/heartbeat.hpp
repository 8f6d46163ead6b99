// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "egocal/acknowledgement_t.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/peers.hpp"
#include "egocal/bus/process.hpp"

namespace egocal::bus {

struct Identity {
  std::string name;  ///< of the process, e.g. egocal-fast
  Role role = Role::monitor;
  std::string version;
  std::int32_t pid = 0;  ///< 0: of this process
};

/// Study: tests/bus/test_loop.cpp; docs/processes.md has what a rig of 20 sensors sends.
struct HeartbeatOptions {
  std::chrono::nanoseconds period{1'000'000'000};  ///< between statuses: what a person who watches expects
  /// Least time between statuses that changes cause [us]: twenty a second are more than any eye follows.
  std::int64_t least_distance_us = 50'000;
  /// Counters of one process; further reasons are counted as "rejected: other". A status of 60 fits one
  /// datagram.
  std::size_t most_counters = 60;
  /// This process looks at the clock every period; after more of these it was stopped (SIGSTOP, Ctrl-Z), and
  /// others were not silent in that time.
  int stopped_periods = 2;
};

/// Sends status_t every period and on change (at most every least_distance_us), and receives those of the
/// others. A namesake is answered at once, so that two processes of one name learn of each other within
/// milliseconds. Where a status cannot be sent the next one reports it; nothing here ever ends the process.
class Heartbeat {
 public:
  Heartbeat(Loop& loop, Identity identity, std::chrono::nanoseconds timeout,
            const HeartbeatOptions& options = {});
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;
  /// end(), without before_publish().
  ~Heartbeat();
  /// Sends the state "ended", once.
  void end();

  const Identity& identity() const { return identity_; }
  std::int64_t run() const { return run_; }

  /// A count that goes out with every status; stays valid.
  std::int64_t& counter(const std::string& name) { return counters_[name]; }
  /// "rejected: <reason>", bounded in number: beyond most_counters they are counted as "rejected: other".
  void reject(const std::string& reason);

  void set_state(State state);
  State state() const { return state_; }
  /// Sets the error of the status; empty: there is none any more. While there is none, a network that is away
  /// is reported in its place.
  void set_error(const std::string& error);

  std::vector<acknowledgement_t>& acknowledgements() { return acknowledgements_; }

  /// Called before a status goes out, to bring counters up to date that are kept elsewhere.
  void before_publish(std::function<void()> callback) { before_publish_ = std::move(callback); }
  /// Called for each status of another process.
  void on_status(std::function<void(const status_t&)> callback) { on_status_ = std::move(callback); }
  void publish();
  /// Sends a status that announces a computation: for up to so long (at most longest_announced_silence) this
  /// process sends nothing, and is not gone. The next status ends it.
  void announce_silence(std::chrono::seconds at_most);

  bool alive(Role role) const;
  /// Whether the network has been there for a whole heartbeat timeout: all others have sent their status.
  bool settled() const;
  std::optional<Role> role_of(const std::string& name) const { return peers_.role_of(name); }
  /// Another living process that has this name and precedes this one, see Peers; empty: there is none.
  std::optional<Peer> senior_namesake() const;

 private:
  void change();
  void hear(const status_t& status);
  std::int64_t awake_us() const;

  Loop& loop_;
  Identity identity_;
  HeartbeatOptions options_;
  std::int64_t timeout_us_;
  std::int64_t unsettled_us_;                     ///< when the network was away last, or the start
  mutable std::int64_t looked_at_us_, awake_us_;  ///< see awake_us()
  std::int64_t run_;
  State state_ = State::waiting;
  std::string error_;
  std::map<std::string, std::int64_t> counters_;
  std::vector<acknowledgement_t> acknowledgements_;
  Peers peers_;
  std::function<void()> before_publish_;
  std::function<void(const status_t&)> on_status_;
  std::int64_t published_us_ = 0;
  bool change_pending_ = false;
  std::chrono::seconds announced_{0};  ///< silence, by the status that is sent
};

}  // namespace egocal::bus
