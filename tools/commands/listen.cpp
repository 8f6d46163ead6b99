// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands/listen.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/plausible.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/bus/stream_watch.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::tools {

namespace {

struct ListenOptions {
  std::string rig, url;
  double seconds = 3;
  bool json = false;
};

/// Poses of all sensors at once: half a second of a large rig at full speed.
constexpr int queue_capacity = 4096;

nlohmann::ordered_json stream_json(const bus::HeardStream& stream, std::int64_t now_us) {
  nlohmann::ordered_json json;
  json["channel"] = bus::printable(stream.channel, 63);
  json["type"] = stream.type;
  json["messages"] = stream.messages;
  json["rate_hz"] = stream.rate > 0 ? nlohmann::ordered_json(stream.rate) : nullptr;
  json["silent_s"] = to_seconds(now_us - stream.last_mono_us);
  json["faults"] = nlohmann::ordered_json::array();
  for (const bus::Refusal& refusal : stream.refusals)
    json["faults"].push_back({{"reason", refusal.reason}, {"count", refusal.count}, {"cure", refusal.cure}});
  return json;
}

nlohmann::ordered_json watch_json(const bus::StreamWatch& watch, std::int64_t now_us) {
  nlohmann::ordered_json json;
  json["sensors"] = nlohmann::ordered_json::array();
  for (const bus::SensorStream& sensor : watch.sensors()) {
    nlohmann::ordered_json entry;
    entry["name"] = sensor.sensor.name;
    entry["expected_channel"] = sensor.sensor.channel;
    entry["expected_type"] =
        sensor.sensor.type == bus::OdometryType::pose ? "bot_core.pose_t" : "egocal.odometry_t";
    entry["heard"] = sensor.heard ? stream_json(*sensor.heard, now_us) : nullptr;
    json["sensors"].push_back(entry);
  }
  json["others"] = nlohmann::ordered_json::array();
  for (const auto& [channel, stream] : watch.others()) json["others"].push_back(stream_json(stream, now_us));
  return json;
}

/// Whether every sensor sends, without a fault. Without a rig: whether anything is received.
bool all_well(const bus::StreamWatch& watch, std::int64_t now_us) {
  if (watch.sensors().empty()) return !watch.others().empty();
  if (watch.misses_any(now_us)) return false;
  for (const bus::SensorStream& sensor : watch.sensors())
    if (!sensor.heard->refusals.empty()) return false;
  return true;
}

void run_listen(const ListenOptions& options) {
  const bus::Rig rig = options.rig.empty() ? bus::Rig{} : bus::read_rig(options.rig);
  bus::Loop loop(options.url.empty() ? rig.lcm_url : options.url);
  bus::StreamWatchOptions watching;
  // a window ends with the first message behind it, which must come before the end
  watching.rate_window_us = static_cast<std::int64_t>(
      std::clamp(options.seconds / 2 * second_us, 1.0, static_cast<double>(watching.rate_window_us)));
  bus::StreamWatch watch(rig.sensors, watching);
  loop.subscribe_prefix(
      "", [&](const bus::Arrival& arrival) { watch.hear(arrival.channel, arrival.bytes, arrival.mono_us); },
      queue_capacity);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  while (std::chrono::steady_clock::now() < end)
    if (!loop.run_once(std::chrono::milliseconds(50))) break;
  const std::int64_t now = loop.mono_us();
  if (options.json) {
    fmt::print("{}\n", watch_json(watch, now).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    for (const bus::StreamLine& line : bus::stream_lines(watch, now)) fmt::print("{}\n", line.text);
    if (watch.sensors().empty() && watch.others().empty())
      fmt::print("nothing is sent on {}\n", options.url.empty() ? rig.lcm_url : options.url);
  }
  if (!all_well(watch, now)) throw cli::Exit{1};
}

}  // namespace

void add_listen(cli::App program) {
  const auto options = std::make_shared<ListenOptions>();
  cli::App command = program.add_subcommand(
      "listen",
      "what the sensors send: channel, type, rate, silence, faults with their cures; exit code 1 "
      "where a sensor is silent or sends what cannot be used");
  command.add_option("RIG", options->rig, "rig file; without it every channel that is received is listed");
  command.add_option("--seconds", options->seconds, "how long [s]; a rate needs two messages in half of it")
      .check(cli::Check::not_negative())
      .show_default();
  command.add_flag("--json", options->json, "machine-readable");
  command.add_option("--lcm-url", options->url, "LCM URL instead of the rig's");
  command.callback([options] { run_listen(*options); });
}

}  // namespace egocal::tools
