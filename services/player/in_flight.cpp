// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "player/in_flight.hpp"

#include <algorithm>

namespace egocal::services {

std::optional<std::int64_t> utime_of(const bus::LogEvent& event) {
  // both types begin with the fingerprint and then utime, 8 bytes each, big endian
  if (event.data.size() < 16) return std::nullopt;
  std::uint64_t value = 0;
  for (std::size_t i = 8; i < 16; ++i) value = value << 8 | std::to_integer<std::uint64_t>(event.data[i]);
  return static_cast<std::int64_t>(value);
}

void InFlight::sent(const bus::LogEvent& event) {
  const auto channel = channels_.find(event.channel);
  if (channel == channels_.end()) return;
  channel->second.messages.push_back({order_++, utime_of(event).value_or(0), event});
}

bool InFlight::acknowledged(const status_t& pairing) {
  const bool new_process = run_ != pairing.run;
  const bool first = !run_;
  bool progress = new_process;
  run_ = pairing.run;
  for (const acknowledgement_t& acknowledgement : pairing.acknowledgements) {
    Channel& channel = channels_[acknowledgement.channel];
    // a new process counts from zero; what the first one had counted before we spoke was not ours
    const std::int64_t before = new_process ? (first ? acknowledgement.count : 0) : channel.count;
    std::int64_t taken = std::max<std::int64_t>(0, acknowledgement.count - before);
    channel.count = acknowledgement.count;
    const bool time_moved = acknowledgement.utime != channel.utime && !first;
    channel.utime = acknowledgement.utime;
    // Counted messages arrived in order; where some were lost the time says which ones are through.
    while (!channel.messages.empty() &&
           (taken > 0 || (time_moved && channel.messages.front().utime <= acknowledgement.utime))) {
      channel.messages.pop_front();
      --taken;
      progress = true;
    }
  }
  return progress;
}

std::size_t InFlight::count() const {
  std::size_t sum = 0;
  for (const auto& [name, channel] : channels_) sum += channel.messages.size();
  return sum;
}

std::vector<bus::LogEvent> InFlight::all() const {
  std::vector<const Message*> messages;
  for (const auto& [name, channel] : channels_)
    for (const Message& message : channel.messages) messages.push_back(&message);
  std::sort(messages.begin(), messages.end(),
            [](const Message* x, const Message* y) { return x->order < y->order; });
  std::vector<bus::LogEvent> events;
  events.reserve(messages.size());
  for (const Message* message : messages) events.push_back(message->event);
  return events;
}

void InFlight::clear() {
  for (auto& [name, channel] : channels_) channel.messages.clear();
}

}  // namespace egocal::services
