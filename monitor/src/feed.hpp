// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <span>
#include <string>

#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

/// One encoded message into the model, whichever of ours it is. False: a channel of ours that could not be
/// decoded.
bool deliver(Model& model, const std::string& channel, std::span<const std::byte> bytes, Now now);

/// The monitor's ear on the bus: all pairs' channels by pattern, taken in batches, as people look ten times a
/// second.
class Feed {
 public:
  /// Throws Error where the URL is not understood or the machine cannot multicast.
  explicit Feed(const std::string& url);
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  /// Hands on what is waiting, for at most about 30 ms.
  void drain(Model& model, Now now);
  void send(const command_t& command);
  /// Says that this monitor is there, once a second at most.
  void send_heartbeat(Now now, const std::string& version);
  std::int64_t undecodable() const { return undecodable_; }

 private:
  void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  lcm::LCM lcm_;
  Model* model_ = nullptr;
  Now now_;
  std::int64_t undecodable_ = 0;
  std::int64_t run_ = 0;
  std::int64_t heartbeat_us_ = 0;
  std::exception_ptr failure_;
};

}  // namespace egocal::monitor
