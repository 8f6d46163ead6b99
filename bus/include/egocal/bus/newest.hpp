// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/loop.hpp"

namespace egocal::bus {

/// Keeps only the newest message of one channel until it is taken: a flood costs time, never memory or age.
template <class Message>
class Newest {
 public:
  Newest(Loop& loop, const std::string& channel) : loop_(&loop), channel_(channel) {
    loop.subscribe_bytes(channel, [this](const Arrival& arrival) {
      if (!is_a<Message>(arrival.bytes)) {  // must not displace a good one
        loop_->count_undecodable(channel_);
        return;
      }
      bytes_.assign(arrival.bytes.begin(), arrival.bytes.end());
      mono_us_ = arrival.mono_us;
      if (fresh_) ++skipped_;
      fresh_ = true;
    });
  }
  Newest(const Newest&) = delete;
  Newest& operator=(const Newest&) = delete;

  /// Takes the newest message. False: there is none since the last call. The loop counts what cannot be
  /// decoded.
  bool take(Message& message) {
    if (!std::exchange(fresh_, false)) return false;
    message = Message{};
    if (decode(bytes_, message)) return true;
    loop_->count_undecodable(channel_);
    return false;
  }

  std::int64_t skipped() const { return skipped_; }  ///< replaced by a newer one before they were taken
  std::int64_t mono_us() const { return mono_us_; }  ///< arrival of the newest

 private:
  Loop* loop_;
  std::string channel_;
  std::vector<std::byte> bytes_;
  std::int64_t mono_us_ = 0;
  std::int64_t skipped_ = 0;
  bool fresh_ = false;
};

}  // namespace egocal::bus
