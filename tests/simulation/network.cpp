// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/network.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/decode.hpp"
#include "egocal/calibration_t.hpp"
#include "egocal/scale_t.hpp"
#include "simulation/allocations.hpp"

namespace egocal::simulation {

namespace {

constexpr std::size_t most_recent = 32;

/// Clears the times of solvers, the only contents of messages that depend on the machine.
void forget_timings(calibration_t& message) {
  message.solve_ns = message.verify_ns = 0;
}
void forget_timings(scale_t& message) {
  message.solve_ns = 0;
}

template <class Message>
std::vector<std::byte> without_timings(bus::Bytes bytes) {
  Message message{};
  if (!bus::decode(bytes, message)) return {bytes.begin(), bytes.end()};
  forget_timings(message);
  return bus::encode(message);
}

}  // namespace

std::uint64_t hash_of(const std::byte* data, std::size_t size) {
  std::uint64_t hash = size;
  for (; size >= 8; data += 8, size -= 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, data, 8);
    hash = mixed(hash, word);
  }
  std::uint64_t rest = 0;
  std::memcpy(&rest, data, size);
  return mixed(hash, rest);
}

/// What has arrived at a process and waits in its kernel.
struct Inbox {
  struct Waiting {
    PacketPtr packet;
    std::int64_t mono_us;
  };
  Address address;
  std::function<void()> wake;
  std::deque<Waiting> waiting;
  std::size_t bytes = 0;
  std::int64_t overflow = 0;
  int burst_left = 0;                               ///< datagrams that are still to be lost
  std::map<std::string, bool, std::less<>> wanted;  ///< as its process asked last
};

class Network::End final : public bus::Transport {
 public:
  End(Network& network, std::shared_ptr<Inbox> inbox, Life& life)
      : network_(network), inbox_(std::move(inbox)), life_(life) {}

  bus::SendStatus send(std::string_view channel, bus::Bytes bytes) override {
    if (life_.over()) return bus::SendStatus::no_network;
    if (life_.ends_here()) {
      life_.stop();
      return bus::SendStatus::no_network;
    }
    if (!bus::fits_datagrams(channel, bytes)) return bus::SendStatus::too_large;
    return network_.send(inbox_->address, channel, bytes, number_++);
  }

  bool receive(const Wanted& wanted, bus::Received& message) override {
    const Wanted remembered = [&](std::string_view channel) {
      const bool is = wanted(channel);
      const auto known = inbox_->wanted.find(channel);
      if (known == inbox_->wanted.end())
        inbox_->wanted.emplace(channel, is);
      else
        known->second = is;
      return is;
    };
    while (!inbox_->waiting.empty()) {
      current_ = std::move(inbox_->waiting.front());
      inbox_->waiting.pop_front();
      inbox_->bytes -= current_.packet->datagram.size();
      const auto found = reassembly_.take(current_.packet->datagram,
                                          static_cast<std::uint64_t>(current_.packet->sender), remembered);
      if (!found) continue;
      message = {found->channel, found->bytes, current_.mono_us};
      const MemoryOwner owner(0);
      if (network_.observer_.received)
        network_.observer_.received(inbox_->address, found->channel, found->bytes);
      return true;
    }
    return false;
  }

  int fd() const override { return -1; }
  bool ready() const override { return !inbox_->waiting.empty(); }
  void check_network() override {}
  std::string network_error() const override {
    return network_.links_[static_cast<std::size_t>(inbox_->address.host)].away
               ? "no multicast to the group: Network is unreachable"
               : "";
  }
  bus::TransportCounts counts() const override {
    return {reassembly_.malformed(), reassembly_.incomplete(), inbox_->overflow};
  }

 private:
  Network& network_;
  std::shared_ptr<Inbox> inbox_;
  Life& life_;
  bus::Reassembly reassembly_;
  Inbox::Waiting current_;
  std::uint32_t number_ = 0;
};

Network::Network(Schedule& schedule, std::vector<std::unique_ptr<Host>>& hosts, const Plan& plan)
    : schedule_(schedule),
      hosts_(hosts),
      faults_(plan.network),
      random_(plan.seed * 3 + 1),
      links_(hosts.size()) {}

std::unique_ptr<bus::Transport> Network::open(const Address& address, Life& life,
                                              std::function<void()> wake) {
  const auto inbox = std::make_shared<Inbox>();
  inbox->address = address;
  inbox->wake = std::move(wake);
  std::erase_if(inboxes_, [](const auto& old) { return old.expired(); });
  inboxes_.push_back(inbox);
  return std::make_unique<End>(*this, inbox, life);
}

bus::SendStatus Network::send(const Address& from, std::string_view channel, bus::Bytes bytes,
                              std::uint32_t number) {
  const MemoryOwner owner(0);
  if (links_[static_cast<std::size_t>(from.host)].away) {
    ++losses_[from.port].not_sent;
    return bus::SendStatus::no_network;
  }
  std::vector<std::byte> cleaned;
  if (channel.starts_with(bus::calibration_prefix)) bytes = cleaned = without_timings<calibration_t>(bytes);
  if (channel.starts_with(bus::scale_prefix)) bytes = cleaned = without_timings<scale_t>(bytes);
  const std::string name(channel);
  if (observer_.sent) observer_.sent(from, name, bytes);
  bus::for_each_datagram(channel, bytes, number, [&](const bus::Datagram& part) {
    const auto packet = std::make_shared<Packet>();
    packet->channel = name;
    packet->datagram.reserve(part.header().size() + part.payload.size());
    packet->datagram.insert(packet->datagram.end(), part.header().begin(), part.header().end());
    packet->datagram.insert(packet->datagram.end(), part.payload.begin(), part.payload.end());
    packet->sender = static_cast<int>(from.port);
    packet->hash = hash_of(packet->datagram.data(), packet->datagram.size());
    recent_.push_back(packet);
    if (recent_.size() > most_recent) recent_.pop_front();
    spread(packet, from.host);
    return true;
  });
  return bus::SendStatus::sent;
}

void Network::inject(Packet packet) {
  packet.hash = hash_of(packet.datagram.data(), packet.datagram.size());
  packet.whole = false;
  packet.sender = -1;
  spread(std::make_shared<Packet>(std::move(packet)), 0);
}

void Network::send_from_outside(const std::string& channel, bus::Bytes message) {
  bus::for_each_datagram(channel, message, 0, [&](const bus::Datagram& part) {
    Packet packet;
    packet.channel = channel;
    packet.datagram.assign(part.header().begin(), part.header().end());
    packet.datagram.insert(packet.datagram.end(), part.payload.begin(), part.payload.end());
    inject(std::move(packet));
    return true;
  });
}

PacketPtr Network::recent(testing::Random& random) const {
  return recent_.empty() ? nullptr : recent_[random.below(recent_.size())];
}

PacketPtr Network::corrupted(const PacketPtr& packet) {
  const bool cut = faults_.truncated > 0 && random_.uniform() < faults_.truncated;
  const bool flip = faults_.flipped > 0 && random_.uniform() < faults_.flipped;
  if (!cut && !flip) return packet;
  const auto changed = std::make_shared<Packet>(*packet);
  changed->whole = false;
  if (cut && !changed->datagram.empty()) changed->datagram.resize(random_.below(changed->datagram.size()));
  if (flip && !changed->datagram.empty())
    changed->datagram[random_.below(changed->datagram.size())] ^= std::byte(1U << random_.below(8));
  changed->hash = hash_of(changed->datagram.data(), changed->datagram.size());
  return changed;
}

bool Network::is_in_burst(Inbox& inbox) {
  if (faults_.burst > 0 && inbox.burst_left == 0 && random_.uniform() < faults_.burst)
    inbox.burst_left = faults_.burst_length;
  if (inbox.burst_left == 0) return false;
  inbox.burst_left = faults_.burst > 0 ? inbox.burst_left - 1 : 0;
  return true;
}

void Network::spread(const PacketPtr& packet, int from_host) {
  for (const std::weak_ptr<Inbox>& listener : inboxes_) {
    const std::shared_ptr<Inbox> inbox = listener.lock();
    if (!inbox) continue;
    // a datagram that no process of the host receives is dropped, however it arrives
    if (packet->whole && !faults_.corrupts()) {
      const auto wanted = inbox->wanted.find(packet->channel);
      if (wanted != inbox->wanted.end() && !wanted->second) continue;
    }
    deliver(packet, from_host, listener);
    if (faults_.duplicated > 0 && random_.uniform() < faults_.duplicated)
      deliver(packet, from_host, listener);
  }
}

void Network::deliver(const PacketPtr& original, int from_host, const std::weak_ptr<Inbox>& listener) {
  const int to_host = listener.lock()->address.host;
  const Link &from = links_[static_cast<std::size_t>(from_host)],
             &to = links_[static_cast<std::size_t>(to_host)];
  if (from_host != to_host && (from.apart || to.apart || to.away)) return;
  if (faults_.lost > 0 && random_.uniform() < faults_.lost) return;
  if (is_in_burst(*listener.lock())) return;
  const PacketPtr packet = corrupted(original);
  std::int64_t delay_us = faults_.delay_us;
  if (faults_.jitter_us > 0)
    delay_us += static_cast<std::int64_t>(random_.below(static_cast<std::uint64_t>(faults_.jitter_us)));
  if (faults_.late > 0 && random_.uniform() < faults_.late) delay_us += faults_.late_by_us;
  if (from_host != to_host)
    delay_us = std::max(delay_us, std::max(from.clogged_until_us, to.clogged_until_us) - schedule_.now_us());
  const auto buffer = static_cast<std::size_t>(faults_.buffer_bytes);
  schedule_.after_us(delay_us, [this, packet, listener, buffer] {
    const std::shared_ptr<Inbox> inbox = listener.lock();
    if (!inbox) return;
    if (inbox->bytes + packet->datagram.size() > buffer) {
      ++inbox->overflow;
      ++losses_[inbox->address.port].overflow;
      return;
    }
    inbox->bytes += packet->datagram.size();
    inbox->waiting.push_back(
        {packet, hosts_[static_cast<std::size_t>(inbox->address.host)]->clock.mono_us()});
    if (observer_.arrived) observer_.arrived(inbox->address, *packet);
    inbox->wake();
  });
}

}  // namespace egocal::simulation
