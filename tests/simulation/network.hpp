// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "egocal/bus/datagrams.hpp"
#include "egocal/bus/transport.hpp"
#include "simulation/host.hpp"
#include "simulation/life.hpp"
#include "simulation/packet.hpp"
#include "simulation/plan.hpp"
#include "support/random_motion.hpp"

namespace egocal::simulation {

/// Where a process is on the network.
struct Address {
  int process = 0;
  int host = 0;
  std::uint64_t port = 0;  ///< differs for every life of a process
};

/// The multicast group: datagrams of LCM's format, as the real transport sends and reassembles them.
class Network {
 public:
  /// Called for every datagram that is sent and for each that a process is handed.
  struct Observer {
    std::function<void(const Address&, const std::string& channel, bus::Bytes message)> sent;
    std::function<void(const Address&, const Packet&)> arrived;
    std::function<void(const Address&, std::string_view channel, bus::Bytes message)> received;
  };

  Network(Schedule& schedule, std::vector<std::unique_ptr<Host>>& hosts, const Plan& plan);

  /// wake: called when something has arrived.
  std::unique_ptr<bus::Transport> open(const Address& address, Life& life, std::function<void()> wake);
  void observe(Observer observer) { observer_ = std::move(observer); }

  void set_faults(const NetworkFaults& faults) { faults_ = faults; }
  void set_away(int host, bool away) { links_[static_cast<std::size_t>(host)].away = away; }
  void set_partition(int host, bool apart) { links_[static_cast<std::size_t>(host)].apart = apart; }
  void set_clogged_until(int host, std::int64_t until_us) {
    links_[static_cast<std::size_t>(host)].clogged_until_us = until_us;
  }
  /// A datagram as it is, from an unknown sender.
  void inject(Packet packet);
  /// A message of a tool that does nothing else, which all get.
  void send_from_outside(const std::string& channel, bus::Bytes message);
  /// What faults took from one life of a process, by its port.
  struct Losses {
    std::int64_t not_sent = 0;  ///< messages: its host was away
    std::int64_t overflow = 0;  ///< datagrams that found its receive buffer full
  };
  Losses losses(std::uint64_t port) const {
    const auto entry = losses_.find(port);
    return entry == losses_.end() ? Losses{} : entry->second;
  }
  /// Some datagram that was sent lately; null: none was.
  PacketPtr recent(testing::Random& random) const;

 private:
  class End;
  struct Link {
    bool away = false, apart = false;
    std::int64_t clogged_until_us = 0;
  };
  bus::SendStatus send(const Address& from, std::string_view channel, bus::Bytes bytes, std::uint32_t number);
  void spread(const PacketPtr& packet, int from_host);
  void deliver(const PacketPtr& packet, int from_host, const std::weak_ptr<struct Inbox>& inbox);
  PacketPtr corrupted(const PacketPtr& packet);
  bool is_in_burst(struct Inbox& inbox);

  Schedule& schedule_;
  std::vector<std::unique_ptr<Host>>& hosts_;
  NetworkFaults faults_;
  testing::Random random_;
  std::vector<Link> links_;
  std::vector<std::weak_ptr<struct Inbox>> inboxes_;
  Observer observer_;
  std::deque<PacketPtr> recent_;
  std::map<std::uint64_t, Losses> losses_;
};

}  // namespace egocal::simulation
