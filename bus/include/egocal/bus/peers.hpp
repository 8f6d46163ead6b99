// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "egocal/bus/process.hpp"
#include "egocal/status_t.hpp"

namespace egocal::bus {

/// Another process, as its heartbeats describe it.
struct Peer {
  std::string name, host;
  std::optional<Role> role;    ///< empty: another version's
  std::optional<State> state;  ///< likewise
  std::int32_t pid = 0;
  std::int64_t run = 0;
  std::int64_t heard_us = 0;  ///< of the loop's clock
  std::int64_t utime = 0;     ///< of its status, by its own date
};

/// What a process compares itself by with others of its name.
struct Namesake {
  std::string name, host;
  std::int64_t run = 0;
  std::int32_t pid = 0;
  State state = State::waiting;
};

/// Who else is on the bus. Bounded: beyond 256 processes the one that was silent longest is forgotten. Times
/// are those of the loop's clock [us].
class Peers {
 public:
  /// Takes a status. True: its process was not known before. "ended" is the last status of a process: one
  /// that it sent before and that the network delivers later does not revive it.
  bool hear(const status_t& status, std::int64_t now_us);

  /// Whether some process of this role is running and sent its status within the timeout.
  bool alive(Role role, std::int64_t now_us, std::int64_t timeout_us) const;
  /// Role of the process of this name that sent last; empty: none did.
  std::optional<Role> role_of(const std::string& name) const;
  /// A living process of the same name that precedes this one. A process that works precedes one that does
  /// not: dates may have been set between two starts, and what works already has the statistics. Where both
  /// or neither work, the smaller (run, host, pid) precedes, which both find alike.
  std::optional<Peer> senior_namesake(const Namesake& self, std::int64_t now_us,
                                      std::int64_t timeout_us) const;

 private:
  struct Key {
    std::string name, host;
    std::int64_t run;
    std::int32_t pid;
    auto operator<=>(const Key&) const = default;
  };
  std::map<Key, Peer> peers_;
};

}  // namespace egocal::bus
