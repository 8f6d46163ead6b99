// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "feed.hpp"

#include <unistd.h>

#include <chrono>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/decode.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/error.hpp"

namespace egocal::monitor {
namespace {

template <class Message>
bool decoded(std::span<const std::byte> bytes, Message& message) {
  message = Message{};
  return bus::decode(bytes, message);
}

bool starts_with(const std::string& text, const char* prefix) {
  return text.rfind(prefix, 0) == 0;
}

// liblcm itself says little, and that after ten seconds: the processes' own connection tells in one line why
// a machine cannot multicast, and what helps.
const std::string& connected(const std::string& url) {
  bus::Loop probe(url, {.handle_signals = false});
  return url;
}

}  // namespace

bool deliver(Model& model, const std::string& channel, std::span<const std::byte> bytes, Now now) {
  if (starts_with(channel, "EGOCAL_PROBLEM_")) {
    problem_t message;
    if (!decoded(bytes, message)) return false;
    model.on_problem(message, now);
  } else if (starts_with(channel, "EGOCAL_CALIBRATION_")) {
    calibration_t message;
    if (!decoded(bytes, message)) return false;
    model.on_calibration(message, now);
  } else if (channel == bus::status_channel) {
    status_t message;
    if (!decoded(bytes, message)) return false;
    model.on_status(message, now);
  } else if (channel == bus::command_channel) {
    command_t message;
    if (!decoded(bytes, message)) return false;
    model.on_command(message, now);
  }
  return true;
}

Feed::Feed(const std::string& url) : lcm_(connected(url)), run_(bus::wall_us()) {
  const auto failed = [&] { return Error("cannot receive on '" + url + "'"); };
  if (!lcm_.good()) throw failed();
  for (const char* pattern :
       {"EGOCAL_PROBLEM_.*", "EGOCAL_CALIBRATION_.*", "EGOCAL_STATUS", "EGOCAL_COMMAND"}) {
    lcm::Subscription* subscription = lcm_.subscribe(pattern, &Feed::receive, this);
    if (subscription == nullptr) throw failed();
    subscription->setQueueCapacity(2000);
  }
  if (lcm_.getFileno() < 0) throw failed();
}

void Feed::receive(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  try {
    // our own heartbeat comes back to us and is of no interest here
    const std::span<const std::byte> bytes(static_cast<const std::byte*>(buffer->data), buffer->data_size);
    if (!deliver(*model_, channel, bytes, now_)) {
      ++undecodable_;
      model_->note(Severity::warning, channel, "a message that could not be decoded: another version?", now_);
    }
  } catch (...) {
    failure_ = std::current_exception();  // must not pass through liblcm's C frames
  }
}

void Feed::drain(Model& model, Now now) {
  model_ = &model;
  now_ = now;
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(30);
  for (int n = 0; lcm_.handleTimeout(0) > 0 && !failure_; ++n)
    if (n % 64 == 63 && std::chrono::steady_clock::now() > until) break;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Feed::send(const command_t& command) {
  lcm_.publish(bus::command_channel, &command);
}

void Feed::send_heartbeat(Now now, const std::string& version) {
  if (heartbeat_us_ != 0 && now.mono_us - heartbeat_us_ < 1000000) return;
  heartbeat_us_ = now.mono_us;
  status_t status{};
  status.utime = now.wall_us;
  status.name = "egocal-monitor";
  status.role = "monitor";
  status.host = bus::host_name();
  status.pid = static_cast<std::int32_t>(getpid());
  status.run = run_;
  status.version = version;
  status.state = "running";
  lcm_.publish(bus::status_channel, &status);
}

}  // namespace egocal::monitor
