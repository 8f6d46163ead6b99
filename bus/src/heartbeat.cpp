// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/heartbeat.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/plausible.hpp"

namespace egocal::bus {

Heartbeat::Heartbeat(Loop& loop, Identity identity, std::chrono::nanoseconds timeout,
                     const HeartbeatOptions& options)
    : loop_(loop),
      identity_(std::move(identity)),
      options_(options),
      timeout_us_(std::chrono::duration_cast<std::chrono::microseconds>(timeout).count()),
      unsettled_us_(loop.mono_us()),
      looked_at_us_(loop.mono_us()),
      awake_us_(looked_at_us_),
      run_(loop.wall_us()) {
  if (identity_.pid == 0) identity_.pid = static_cast<std::int32_t>(getpid());
  loop_.subscribe<status_t>(status_channel, [this](const status_t& status, const Arrival&) { hear(status); });
  loop_.every(options_.period, [this] { publish(); });
  // after the owner's constructor: its first status is complete
  loop_.after(std::chrono::nanoseconds{0}, [this] { publish(); });
}

Heartbeat::~Heartbeat() {
  before_publish_ = nullptr;  // its owner may be gone by now
  end();
}

void Heartbeat::end() {
  if (state_ == State::ended) return;
  state_ = State::ended;
  publish();
}

void Heartbeat::reject(const std::string& reason) {
  const std::string name = "rejected: " + reason;
  const auto known = counters_.find(name);
  if (known != counters_.end())
    ++known->second;
  else
    ++counters_[counters_.size() < options_.most_counters ? name : "rejected: other"];
}

void Heartbeat::set_state(State state) {
  if (state == state_) return;
  state_ = state;
  change();
}

void Heartbeat::set_error(const std::string& error) {
  constexpr std::size_t most_bytes = 400;  // a limit: two errors at once, and the status fits one datagram
  std::string text = printable(error, most_bytes);
  if (text == error_) return;
  error_ = std::move(text);
  change();
}

void Heartbeat::change() {
  if (change_pending_) return;
  change_pending_ = true;
  const std::int64_t wait = published_us_ + options_.least_distance_us - loop_.mono_us();
  loop_.after(std::chrono::microseconds(std::max<std::int64_t>(wait, 0)), [this] {
    if (change_pending_) publish();
  });
}

/// Time of the loop's clock without the time in which this process was stopped, to measure how long others
/// have been silent.
std::int64_t Heartbeat::awake_us() const {
  const std::int64_t longest_us =
      std::chrono::duration_cast<std::chrono::microseconds>(options_.stopped_periods * options_.period)
          .count();
  const std::int64_t now = loop_.mono_us();
  awake_us_ += std::min(now - looked_at_us_, longest_us);
  looked_at_us_ = now;
  return awake_us_;
}

void Heartbeat::publish() {
  awake_us();
  if (before_publish_) before_publish_();
  status_t message{};
  message.utime = loop_.wall_us();
  message.name = identity_.name;
  message.role = role_name(identity_.role);
  message.host = loop_.host();
  message.pid = identity_.pid;
  message.run = run_;
  message.version = identity_.version;
  message.state = state_name(state_);
  message.last_error = error_.empty() ? loop_.network_error() : error_;
  const auto count = [&message](const std::string& name, std::int64_t value) {
    counter_t& counter = message.counters.emplace_back();
    counter.name = name;
    counter.value = value;
  };
  for (const auto& [name, value] : counters_) count(name, value);
  for (const auto& [channel, value] : loop_.undecodable())
    count("rejected: not decodable on " + channel, value);
  const LoopCounts counts = loop_.counts();
  for (const auto& [name, value] :
       {std::pair{"not sent", counts.not_sent}, std::pair{"dropped: queue full", counts.queue_full},
        std::pair{"dropped: receive buffer full", counts.transport.buffer_overflow},
        std::pair{"rejected: malformed datagrams", counts.transport.malformed},
        std::pair{"rejected: incomplete messages", counts.transport.incomplete}})
    if (value > 0) count(name, value);
  if (announced_.count() > 0) count(std::string(announced_silence_counter), announced_.count());
  message.n_counters = static_cast<std::int32_t>(message.counters.size());
  message.acknowledgements = acknowledgements_;
  message.n_acknowledgements = static_cast<std::int32_t>(acknowledgements_.size());
  published_us_ = loop_.mono_us();
  change_pending_ = false;
  loop_.publish(status_channel, message);
  if (!loop_.network_error().empty()) unsettled_us_ = published_us_;
}

void Heartbeat::announce_silence(std::chrono::seconds at_most) {
  announced_ = at_most;
  publish();
  announced_ = {};
}

void Heartbeat::hear(const status_t& status) {
  if (status.run == run_ && status.pid == identity_.pid && status.host == loop_.host()) return;
  if (!plausible_name(status.name) || !plausible_name(status.role) || status.host.size() > 255 ||
      status.run < 0) {
    reject("status out of range");
    return;
  }
  const std::int64_t now = loop_.mono_us();
  const bool namesake = status.name == identity_.name && status.state != state_name(State::ended);
  const bool is_new = peers_.hear(status, awake_us());
  if (is_new && status.version != identity_.version) ++counters_["other versions heard"];
  if (namesake && now - published_us_ > options_.least_distance_us)
    publish();
  else if (namesake && is_new)
    change();  // it waits for an answer before it sends anything
  if (on_status_) on_status_(status);
}

bool Heartbeat::settled() const {
  return loop_.mono_us() - unsettled_us_ > timeout_us_;
}

bool Heartbeat::alive(Role role) const {
  return peers_.alive(role, awake_us(), timeout_us_);
}

std::optional<Peer> Heartbeat::senior_namesake() const {
  return peers_.senior_namesake({identity_.name, loop_.host(), run_, identity_.pid, state_}, awake_us(),
                                timeout_us_);
}

}  // namespace egocal::bus
