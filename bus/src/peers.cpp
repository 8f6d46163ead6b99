// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/peers.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>

#include "egocal/bus/check.hpp"

namespace egocal::bus {

namespace {
constexpr std::size_t max_peers = 256;  // a limit on memory

bool is_alive(const Peer& peer, std::int64_t now_us, std::int64_t timeout_us) {
  return peer.state != State::ended && now_us - peer.heard_us <= timeout_us;
}
/// Whether a process works. A paused one does: it has the statistics and continues with them. A state of
/// another version is unknown.
bool works(std::optional<State> state) {
  return state && *state != State::waiting && *state != State::ended;
}
}  // namespace

bool Peers::hear(const status_t& status, std::int64_t now_us) {
  const Key key{status.name, status.host, status.run, status.pid};
  const auto known = peers_.find(key);
  const bool is_new = known == peers_.end();
  if (!is_new && known->second.state == State::ended && status.utime <= known->second.utime) return false;
  peers_[key] = {status.name,
                 status.host,
                 role_from_name(status.role),
                 state_from_name(status.state),
                 status.pid,
                 status.run,
                 now_us,
                 status.utime};
  if (peers_.size() > max_peers)
    peers_.erase(std::min_element(peers_.begin(), peers_.end(), [](const auto& x, const auto& y) {
      return x.second.heard_us < y.second.heard_us;
    }));
  EGOCAL_CHECK(peers_.size() <= max_peers, "the number of peers is bounded");
  return is_new;
}

bool Peers::alive(Role role, std::int64_t now_us, std::int64_t timeout_us) const {
  return std::any_of(peers_.begin(), peers_.end(), [&](const auto& entry) {
    const Peer& peer = entry.second;
    return peer.role == role && peer.state != State::paused && is_alive(peer, now_us, timeout_us);
  });
}

std::optional<Role> Peers::role_of(const std::string& name) const {
  const Peer* found = nullptr;
  for (const auto& [key, peer] : peers_)
    if (peer.name == name && (!found || peer.heard_us > found->heard_us)) found = &peer;
  return found ? found->role : std::nullopt;
}

std::optional<Peer> Peers::senior_namesake(const Namesake& self, std::int64_t now_us,
                                           std::int64_t timeout_us) const {
  const auto rank = [](const auto& process) {
    return std::make_tuple(!works(process.state), process.run, std::string_view(process.host), process.pid);
  };
  for (const auto& [key, peer] : peers_)
    if (peer.name == self.name && is_alive(peer, now_us, timeout_us) && rank(peer) < rank(self)) return peer;
  return std::nullopt;
}

}  // namespace egocal::bus
