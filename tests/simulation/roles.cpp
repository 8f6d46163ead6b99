// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/roles.hpp"

#include "egocal/bus/channels.hpp"
#include "simulation/host.hpp"

namespace egocal::simulation {

namespace {
using namespace std::chrono_literals;
constexpr int monitor_queue = 2000;  // as egocal-monitor
}  // namespace

Watcher::Watcher(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig) {
  for (const bus::PairConfig& pair : rig.pairs) model_.expect_pair(pair.a, pair.b);
  const auto now = [&loop] { return monitor::Now{loop.mono_us(), loop.wall_us()}; };
  const auto deliver = [this, now](const bus::Arrival& arrival) {
    delivery_.deliver(arrival.channel, arrival.bytes, now());
  };
  loop.subscribe_prefix(bus::problem_prefix, deliver, monitor_queue);
  loop.subscribe_prefix(bus::calibration_prefix, deliver, monitor_queue);
  loop.subscribe_prefix(bus::verdict_prefix, deliver, monitor_queue);
  loop.subscribe_prefix(bus::scale_problem_prefix, deliver, monitor_queue);
  loop.subscribe_prefix(bus::scale_prefix, deliver, monitor_queue);
  loop.subscribe_bytes(bus::status_channel, deliver, monitor_queue);
  loop.subscribe_bytes(bus::command_channel, deliver);
  heartbeat.set_state(bus::State::running);
  loop.every(500ms, [this, now] { model_.tick(now()); });
}

Exporter::Exporter(bus::Loop& loop, const bus::Rig& rig) {
  answers_.expect_scales(rig);
  for (const bus::PairConfig& pair : rig.pairs) {
    loop.subscribe<problem_t>(
        bus::problem_channel(pair.a, pair.b),
        [this](const problem_t& message, const bus::Arrival&) { answers_.hear(message); });
    loop.subscribe<calibration_t>(
        bus::calibration_channel(pair.a, pair.b),
        [this](const calibration_t& message, const bus::Arrival&) { answers_.hear(message); });
    loop.subscribe<verdict_t>(
        bus::verdict_channel(pair.a, pair.b),
        [this](const verdict_t& message, const bus::Arrival&) { answers_.hear(message); });
    loop.subscribe<scale_problem_t>(
        bus::scale_problem_channel(pair.a, pair.b),
        [this](const scale_problem_t& message, const bus::Arrival&) { answers_.hear(message); });
    loop.subscribe<scale_t>(bus::scale_channel(pair.a, pair.b),
                            [this](const scale_t& message, const bus::Arrival&) { answers_.hear(message); });
  }
}

Odometry::Odometry(bus::Loop& loop, const Schedule& schedule, const Drive& drive, std::size_t channel)
    : loop_(loop), schedule_(schedule), drive_(drive), channel_(channel) {
  send_next();
}

void Odometry::send_next() {
  // a sensor measures in true time, whatever the clocks of its host show
  const auto wait_us = [this] {
    return drive_.messages[next_].time_us - HostClock::start_of_all_us - schedule_.now_us();
  };
  while (next_ < drive_.messages.size() && (drive_.messages[next_].channel != channel_ || wait_us() < 0))
    ++next_;
  if (next_ == drive_.messages.size()) return;
  loop_.after(std::chrono::microseconds(wait_us()), [this] {
    loop_.publish_bytes(drive_.rig.sensors[channel_].channel, drive_.messages[next_].bytes);
    ++next_;
    send_next();
  });
}

}  // namespace egocal::simulation
