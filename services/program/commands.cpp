// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "program/commands.hpp"

#include <optional>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"

namespace egocal::services {

namespace {

std::optional<Verb> verb_from_name(const std::string& name) {
  if (name == "reset") return Verb::reset;
  if (name == "pause") return Verb::pause;
  if (name == "resume") return Verb::resume;
  return std::nullopt;
}

bool plausible(const command_t& command) {
  if (command.sensor_a.empty() && command.sensor_b.empty()) return command.session >= 0;
  return bus::plausible_name(command.sensor_a) && bus::plausible_name(command.sensor_b) &&
         command.session >= 0;
}

}  // namespace

void hear_commands(bus::Loop& loop, bus::Heartbeat& heartbeat,
                   std::function<void(Verb, const command_t&)> callback) {
  loop.subscribe<command_t>(bus::command_channel, [&heartbeat, callback = std::move(callback)](
                                                      const command_t& command, const bus::Arrival&) {
    if (command.to != "*" && command.to != heartbeat.identity().name) return;
    const std::optional<Verb> verb = verb_from_name(command.verb);
    if (!verb || !plausible(command))
      heartbeat.reject(not_understood);
    else
      callback(*verb, command);
  });
}

bool means(const command_t& command, Verb verb, const std::string& sensor_a, const std::string& sensor_b,
           std::int64_t session) {
  const bool pair = (command.sensor_a.empty() && command.sensor_b.empty()) ||
                    (command.sensor_a == sensor_a && command.sensor_b == sensor_b);
  return pair && (verb != Verb::reset || command.session == 0 || command.session == session);
}

}  // namespace egocal::services
