// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "delivery.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/stream_watch.hpp"
#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

struct FeedOptions {
  std::string url;
  std::string version;
  double heartbeat_timeout = 3;      ///< [s]
  std::vector<bus::Sensor> sensors;  ///< of the rig; empty: no rig is known, and streams are not watched
};

/// Connects the monitor to the bus: loop and heartbeat, as every process has, and the channels of all pairs.
class Feed {
 public:
  /// Throws Error if the URL is not understood. A missing network is shown and awaited.
  Feed(Model& model, const FeedOptions& options);
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  /// Also returns when one of these is readable.
  void watch(const std::vector<int>& fds);
  /// Waits for something to happen, at most this long [ms], and delivers what has arrived.
  void wait(int milliseconds);
  Now now() const;
  /// Sends a command. False: it was not sent, see error().
  bool send(const command_t& command) { return loop_.publish(bus::command_channel, command); }
  const std::string& error() const { return loop_.send_error(); }
  /// Why the network is away, with the remedy; empty: it is there.
  const std::string& network_error() const { return loop_.network_error(); }

 private:
  void watch_streams();
  std::string why_silent() const;

  Model& model_;
  Delivery delivery_;
  bus::StreamWatch streams_;
  bus::Loop loop_;
  bus::Heartbeat heartbeat_;
};

}  // namespace egocal::monitor
