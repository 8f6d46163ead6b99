// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "feed.hpp"

#include <algorithm>
#include <chrono>

namespace egocal::monitor {

namespace {

/// Capacity of the queue that all pairs share: some tenths of a second of a large rig at full speed.
constexpr int queue_capacity = 2000;

std::chrono::nanoseconds nanoseconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}

}  // namespace

Feed::Feed(Model& model, const FeedOptions& options)
    : model_(model),
      delivery_(model),
      streams_(options.sensors),
      loop_(options.url, {.handle_signals = false, .require_network = false}),
      heartbeat_(loop_, {"egocal-monitor", bus::Role::monitor, options.version},
                 nanoseconds(options.heartbeat_timeout)) {
  const auto deliver = [this](const bus::Arrival& arrival) {
    delivery_.deliver(arrival.channel, arrival.bytes, now());
  };
  loop_.subscribe_prefix(bus::problem_prefix, deliver, queue_capacity);
  loop_.subscribe_prefix(bus::calibration_prefix, deliver, queue_capacity);
  loop_.subscribe_prefix(bus::verdict_prefix, deliver, queue_capacity);
  loop_.subscribe_prefix(bus::scale_problem_prefix, deliver, queue_capacity);
  loop_.subscribe_prefix(bus::scale_prefix, deliver, queue_capacity);
  loop_.subscribe_bytes(bus::status_channel, deliver, queue_capacity);
  loop_.subscribe_bytes(bus::command_channel, deliver);
  if (!options.sensors.empty()) watch_streams();
  const auto report = [this](const std::string& error) { model_.set_network(error, now()); };
  if (!loop_.network_error().empty()) report(loop_.network_error());
  loop_.on_network(report);
  heartbeat_.set_state(bus::State::running);
}

/// Watches the channels of the sensors, and all other channels while one of them is missing.
void Feed::watch_streams() {
  const auto hear = [this](const bus::Arrival& arrival) {
    if (const std::optional<bus::Refusal> first =
            streams_.hear(arrival.channel, arrival.bytes, arrival.mono_us))
      model_.note(Severity::warning, arrival.channel, first->reason + ": " + first->cure, now());
  };
  for (const bus::SensorStream& stream : streams_.sensors())
    loop_.subscribe_bytes(stream.sensor.channel, hear, queue_capacity);
  loop_.subscribe_others(hear, [this] { return streams_.misses_any(loop_.mono_us()); });
  loop_.every(std::chrono::milliseconds(500), [this] {
    const std::int64_t mono_us = loop_.mono_us();
    model_.set_streams(bus::stream_lines(streams_, mono_us, why_silent()));
    for (std::size_t i = 0; i < model_.pairs().size(); ++i) {
      const PairState& pair = model_.pairs()[i];
      model_.set_why_standing(i, bus::why_no_motion(streams_, pair.a, pair.b, mono_us));
    }
  });
}

/// Why sensors may be silent: in a log they send only when the player does, and the player waits for pairing.
std::string Feed::why_silent() const {
  const ProcessState* player = nullptr;
  for (const ProcessState& process : model_.processes())
    if (process.status.role == bus::role_name(Role::player) &&
        (!player || player->at.mono_us < process.at.mono_us))
      player = &process;
  if (!loop_.network_error().empty()) return "the network is away";
  if (!player) return {};
  if (player->state == bus::State::ended) return "the player has ended";
  if (player->state == bus::State::paused) return "the player is paused";
  const bool waits = std::any_of(model_.pairs().begin(), model_.pairs().end(), [](const PairState& pair) {
    return pairing_is_silent(pair) && !session_has_no_motion(pair);
  });
  return player->alive && waits ? "the player waits for pairing, which is silent" : "";
}

void Feed::watch(const std::vector<int>& fds) {
  for (const int fd : fds) loop_.watch(fd, [] {});  // its owner looks after every turn
}

void Feed::wait(int milliseconds) {
  loop_.run_once(std::chrono::milliseconds(milliseconds));
}

Now Feed::now() const {
  return {loop_.mono_us(), loop_.wall_us()};
}

}  // namespace egocal::monitor
