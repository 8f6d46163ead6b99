// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "player/in_flight.hpp"

#include <algorithm>
#include <set>

#include "egocal/bus/check.hpp"
#include "egocal/bus/odometry.hpp"

namespace egocal::services {

namespace {
const std::string held_back_prefix = "held back: ";
}  // namespace

void InFlight::sent(const bus::LogEvent& event) {
  const auto channel = channels_.find(event.channel);
  if (channel == channels_.end()) return;
  channel->second.was_sent = true;
  channel->second.messages.push_back({order_++, bus::utime_in(event.data), event});
}

InFlight::Progress InFlight::acknowledged(const status_t& pairing) {
  const bool new_process = run_ != pairing.run;
  const bool first = !run_;
  Progress progress{new_process, false};
  run_ = pairing.run;
  std::set<std::string> held_back;
  for (const counter_t& counter : pairing.counters)
    if (counter.value > 0 && counter.name.starts_with(held_back_prefix))
      held_back.insert(counter.name.substr(held_back_prefix.size()));
  for (const acknowledgement_t& acknowledgement : pairing.acknowledgements) {
    if (!make_room_for(acknowledgement.channel)) continue;
    Channel& channel = channels_[acknowledgement.channel];
    if (new_process) channel.gap.reset();
    const bool began = channel.utime == 0 && acknowledgement.utime != 0;
    const bool news =
        new_process || acknowledgement.count != channel.count || acknowledgement.utime != channel.utime;
    channel.count = acknowledgement.count;
    channel.utime = acknowledgement.utime;
    const auto through =
        std::find_if(channel.messages.begin(), channel.messages.end(),
                     [&](const Message& message) { return message.utime == acknowledgement.utime; });
    if (news && through != channel.messages.end()) {
      channel.messages.erase(channel.messages.begin(), through + 1);
      progress.any = true;
    }
    progress.any = progress.any || began;
    if (began && !new_process && !channel.messages.empty()) progress.send_again = true;
    if (channel.gap != acknowledgement.utime) {
      channel.gap = acknowledgement.utime;
      channel.sent_again = 0;
      channel.next_try = acknowledgement.count;
    }
    channel.held_back = held_back.contains(acknowledgement.channel);
    if (channel.held_back && !channel.messages.empty() && channel.sent_again < options_.most_tries &&
        acknowledgement.count >= channel.next_try) {
      ++channel.sent_again;
      channel.next_try = acknowledgement.count + static_cast<std::int64_t>(channel.messages.size());
      progress.send_again = true;
    }
  }
  if (new_process && !first && count() > 0) progress.send_again = true;
  return progress;
}

std::vector<acknowledgement_t> InFlight::following() const {
  std::vector<acknowledgement_t> following;
  for (const auto& [name, channel] : channels_) {
    if (!channel.held_back || channel.sent_again < options_.most_tries) continue;
    std::optional<std::int64_t> next;
    for (const Message& message : channel.messages)
      if (message.utime > channel.utime) next = std::min(next.value_or(message.utime), message.utime);
    if (!next) continue;
    following.emplace_back();
    following.back().channel = name;
    following.back().utime = *next;
    following.back().count = channel.sent_again;
  }
  return following;
}

bool InFlight::begins(const std::string& channel) const {
  const auto entry = channels_.find(channel);
  return entry != channels_.end() && entry->second.utime == 0 && !entry->second.messages.empty();
}

/// If names are forged, the real ones return with the next real status.
bool InFlight::make_room_for(const std::string& channel) {
  if (channels_.size() < options_.most_channels || channels_.contains(channel)) return true;
  const auto unused = std::find_if(channels_.begin(), channels_.end(),
                                   [](const auto& entry) { return !entry.second.was_sent; });
  if (unused == channels_.end()) return false;
  channels_.erase(unused);
  EGOCAL_CHECK(channels_.size() < options_.most_channels, "the number of channels in flight is bounded");
  return true;
}

std::size_t InFlight::count() const {
  std::size_t sum = 0;
  for (const auto& [name, channel] : channels_) sum += channel.messages.size();
  return sum;
}

std::vector<bus::LogEvent> InFlight::all() const {
  std::vector<const Message*> messages;
  for (const auto& [name, channel] : channels_)
    for (const Message& message : channel.messages) {
      messages.push_back(&message);
      if (channel.utime == 0) break;
    }
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
