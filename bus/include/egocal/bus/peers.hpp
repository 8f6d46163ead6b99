// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "egocal/status_t.hpp"

namespace egocal::bus {

/// Another process, as its heartbeats tell.
struct Peer {
  std::string name, role, host, state;
  std::int32_t pid = 0;
  std::int64_t run = 0;
  std::chrono::steady_clock::time_point heard;
};

/// Who else is on the bus. Bounded: the longest unheard are forgotten beyond 256.
class Peers {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// True: not heard before.
  bool hear(const status_t& status, Time now);

  /// Some process of this role is running and was heard within the timeout.
  bool alive(const std::string& role, Time now, std::chrono::nanoseconds timeout) const;
  /// Role of the process of this name heard last; empty: never heard.
  std::string role_of(const std::string& name) const;
  /// Another run of this name that is alive and started earlier.
  std::optional<Peer> elder_namesake(const std::string& name, std::int64_t run, const std::string& host,
                                     std::int32_t pid, Time now, std::chrono::nanoseconds timeout) const;

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
