// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/heartbeat.hpp"

#include <unistd.h>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/glue.hpp"

namespace egocal::bus {

namespace {
constexpr std::chrono::seconds period{1};
constexpr std::chrono::milliseconds least_distance{50};  // of statuses caused by changes
constexpr std::size_t max_counters = 60;
}  // namespace

Heartbeat::Heartbeat(Loop& loop, Identity identity, std::chrono::nanoseconds timeout)
    : loop_(loop),
      identity_(std::move(identity)),
      timeout_(timeout),
      host_(host_name()),
      pid_(static_cast<std::int32_t>(getpid())),
      run_(wall_us()) {
  loop_.subscribe<status_t>(status_channel, [this](const status_t& status, const Arrival&) { hear(status); });
  loop_.every(period, [this] { publish(); });
  // after the owner's constructor: its first status is complete
  loop_.after(std::chrono::nanoseconds{0}, [this] { publish(); });
}

Heartbeat::~Heartbeat() {
  before_publish_ = nullptr;  // who counts may be gone by now
  end();
}

void Heartbeat::end() {
  if (state_ == "ended") return;
  state_ = "ended";
  try {
    publish();
  } catch (const std::exception&) {
    // the others will notice the silence
  }
}

void Heartbeat::reject(const std::string& reason) {
  const std::string name = "rejected: " + reason;
  const auto known = counters_.find(name);
  if (known != counters_.end())
    ++known->second;
  else
    ++counters_[counters_.size() < max_counters ? name : "rejected: other"];
}

void Heartbeat::set_state(const std::string& state) {
  if (state == state_) return;
  state_ = state;
  change();
}

void Heartbeat::set_error(const std::string& error) {
  std::string text = printable(error);
  if (text == error_) return;
  error_ = std::move(text);
  change();
}

void Heartbeat::change() {
  if (change_pending_) return;
  change_pending_ = true;
  const auto wait = published_ + least_distance - std::chrono::steady_clock::now();
  loop_.after(std::max<std::chrono::nanoseconds>(wait, std::chrono::nanoseconds{0}), [this] {
    if (change_pending_) publish();
  });
}

void Heartbeat::publish() {
  if (before_publish_) before_publish_();
  status_t message{};
  message.utime = wall_us();
  message.name = identity_.name;
  message.role = identity_.role;
  message.host = host_;
  message.pid = pid_;
  message.run = run_;
  message.version = identity_.version;
  message.state = state_;
  message.last_error = error_;
  for (const auto& [name, value] : counters_) {
    message.counters.emplace_back();
    message.counters.back().name = name;
    message.counters.back().value = value;
  }
  for (const auto& [channel, count] : loop_.undecodable()) {
    message.counters.emplace_back();
    message.counters.back().name = "rejected: not decodable on " + channel;
    message.counters.back().value = count;
  }
  message.n_counters = static_cast<std::int32_t>(message.counters.size());
  message.acknowledgements = acknowledgements_;
  message.n_acknowledgements = static_cast<std::int32_t>(acknowledgements_.size());
  published_ = std::chrono::steady_clock::now();
  change_pending_ = false;
  loop_.publish(status_channel, message);
}

void Heartbeat::hear(const status_t& status) {
  if (status.run == run_ && status.pid == pid_ && status.host == host_) return;
  if (!plausible_name(status.name) || !plausible_name(status.role) || status.host.size() > 255 ||
      status.run < 0) {
    reject("status out of range");
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  const bool namesake = status.name == identity_.name && status.state != "ended";
  const bool is_new = peers_.hear(status, now);
  if (is_new && status.version != identity_.version) ++counters_["other versions heard"];
  if (namesake && now - published_ > least_distance)
    publish();
  else if (namesake && is_new)
    change();  // it waits for an answer before it sends anything
  if (on_status_) on_status_(status);
}

bool Heartbeat::alive(const std::string& role) const {
  return peers_.alive(role, std::chrono::steady_clock::now(), timeout_);
}

std::optional<Peer> Heartbeat::elder_namesake() const {
  return peers_.elder_namesake(identity_.name, run_, host_, pid_, std::chrono::steady_clock::now(), timeout_);
}

}  // namespace egocal::bus
