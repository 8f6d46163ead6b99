// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/bus/loop.hpp"

namespace egocal::bus {

/// Messages between transport and handlers, in the order of arrival. Each subscription has its own capacity
/// and room for one message of the largest size, so a flood on one channel displaces nothing on another.
class MessageQueue {
 public:
  void subscribe(const std::string& channel, bool prefix, Loop::Handler handler, int capacity);

  /// What no other subscription takes, while wanted() states it.
  void subscribe_others(Loop::Handler handler, std::function<bool()> wanted, int capacity);

  /// Takes what the transport has, up to some hundred messages.
  void fill(Transport& transport);
  bool empty() const { return waiting_.empty(); }
  /// Removes the oldest message and calls its handler. The queue must not be empty.
  void handle_one();
  /// Messages that found their subscription's queue full.
  std::int64_t dropped() const { return dropped_; }

 private:
  struct Subscriber {
    Loop::Handler handler;
    int capacity = 0;
    int waiting = 0;
    std::size_t bytes = 0;  ///< of what waits
  };
  struct Waiting {
    Subscriber* subscriber;
    std::string channel;
    std::vector<std::byte> bytes;
    std::int64_t mono_us;
  };

  bool named(std::string_view channel) const;
  void put(Subscriber& subscriber, const Received& message);

  std::deque<Subscriber> subscribers_;  // addresses stay valid
  std::map<std::string, std::vector<Subscriber*>, std::less<>> by_name_;
  std::vector<std::pair<std::string, Subscriber*>> by_prefix_;
  Subscriber* others_ = nullptr;
  std::function<bool()> others_wanted_;
  std::deque<Waiting> waiting_;
  std::size_t bytes_ = 0;
  std::int64_t dropped_ = 0;
};

}  // namespace egocal::bus
