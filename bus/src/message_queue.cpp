// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "message_queue.hpp"

#include <algorithm>
#include <utility>

#include "egocal/bus/check.hpp"

namespace egocal::bus {

namespace {

/// Messages taken from the transport before handlers get their turn again.
constexpr int fill_at_once = 256;
/// Size of all waiting messages [bytes]; several times what the queues of a large rig hold.
constexpr std::size_t max_bytes = std::size_t{64} << 20;
/// What each subscription may hold beyond that [bytes]: one message of the largest size that is received.
constexpr std::size_t assured_bytes = std::size_t{4} << 20;

}  // namespace

void MessageQueue::subscribe(const std::string& channel, bool prefix, Loop::Handler handler, int capacity) {
  Subscriber& subscriber = subscribers_.emplace_back();
  subscriber.handler = std::move(handler);
  subscriber.capacity = capacity;
  if (prefix)
    by_prefix_.emplace_back(channel, &subscriber);
  else
    by_name_[channel].push_back(&subscriber);
}

void MessageQueue::subscribe_others(Loop::Handler handler, std::function<bool()> wanted, int capacity) {
  others_ = &subscribers_.emplace_back();
  others_->handler = std::move(handler);
  others_->capacity = capacity;
  others_wanted_ = std::move(wanted);
}

bool MessageQueue::named(std::string_view channel) const {
  return by_name_.contains(channel) ||
         std::any_of(by_prefix_.begin(), by_prefix_.end(),
                     [&](const auto& entry) { return channel.starts_with(entry.first); });
}

void MessageQueue::fill(Transport& transport) {
  const bool others = others_ && others_wanted_();
  const Transport::Wanted is_wanted = [&](std::string_view channel) { return others || named(channel); };
  Received message;
  for (int i = 0; i < fill_at_once && transport.receive(is_wanted, message); ++i) {
    if (others && !named(message.channel)) {
      put(*others_, message);
      continue;
    }
    if (const auto entry = by_name_.find(message.channel); entry != by_name_.end())
      for (Subscriber* subscriber : entry->second) put(*subscriber, message);
    for (const auto& [prefix, subscriber] : by_prefix_)
      if (message.channel.starts_with(prefix)) put(*subscriber, message);
  }
}

void MessageQueue::put(Subscriber& subscriber, const Received& message) {
  const std::size_t size = message.bytes.size();
  const bool no_room = bytes_ + size > max_bytes && subscriber.bytes + size > assured_bytes;
  if (subscriber.waiting >= subscriber.capacity || no_room) {
    ++dropped_;
    return;
  }
  ++subscriber.waiting;
  subscriber.bytes += size;
  bytes_ += size;
  waiting_.push_back({&subscriber,
                      std::string(message.channel),
                      {message.bytes.begin(), message.bytes.end()},
                      message.mono_us});
}

void MessageQueue::handle_one() {
  EGOCAL_CHECK(!waiting_.empty(), "a message waits when one is handled");
  const Waiting message = std::move(waiting_.front());
  waiting_.pop_front();
  --message.subscriber->waiting;
  message.subscriber->bytes -= message.bytes.size();
  bytes_ -= message.bytes.size();
  EGOCAL_CHECK(message.subscriber->waiting >= 0 && (!waiting_.empty() || bytes_ == 0),
               "an empty queue holds no bytes");
  message.subscriber->handler({message.channel, message.bytes, message.mono_us});
}

}  // namespace egocal::bus
