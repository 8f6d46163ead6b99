// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/peers.hpp"

#include <algorithm>
#include <tuple>

namespace egocal::bus {

namespace {
constexpr std::size_t max_peers = 256;

bool is_alive(const Peer& peer, Peers::Time now, std::chrono::nanoseconds timeout) {
  return peer.state != "ended" && now - peer.heard <= timeout;
}
}  // namespace

bool Peers::hear(const status_t& status, Time now) {
  const Key key{status.name, status.host, status.run, status.pid};
  const bool is_new = !peers_.contains(key);
  peers_[key] = {status.name, status.role, status.host, status.state, status.pid, status.run, now};
  if (peers_.size() > max_peers)
    peers_.erase(std::min_element(peers_.begin(), peers_.end(), [](const auto& x, const auto& y) {
      return x.second.heard < y.second.heard;
    }));
  return is_new;
}

bool Peers::alive(const std::string& role, Time now, std::chrono::nanoseconds timeout) const {
  return std::any_of(peers_.begin(), peers_.end(), [&](const auto& entry) {
    const Peer& peer = entry.second;
    return peer.role == role && peer.state != "paused" && is_alive(peer, now, timeout);
  });
}

std::string Peers::role_of(const std::string& name) const {
  const Peer* found = nullptr;
  for (const auto& [key, peer] : peers_)
    if (peer.name == name && (!found || peer.heard > found->heard)) found = &peer;
  return found ? found->role : std::string{};
}

std::optional<Peer> Peers::elder_namesake(const std::string& name, std::int64_t run, const std::string& host,
                                          std::int32_t pid, Time now,
                                          std::chrono::nanoseconds timeout) const {
  for (const auto& [key, peer] : peers_)
    if (peer.name == name && is_alive(peer, now, timeout) &&
        std::tie(peer.run, peer.host, peer.pid) < std::tie(run, host, pid))
      return peer;
  return std::nullopt;
}

}  // namespace egocal::bus
