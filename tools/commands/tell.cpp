// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <memory>

#include "arguments.hpp"
#include "commands/commands.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"

namespace egocal::tools {

namespace {

struct Options {
  std::string to, verb, value, rig, url;
};

/// What goes into the message: the verb, with its number where it has one.
std::string words(const Options& options) {
  const bool with_number = options.verb == "seek" || options.verb == "speed";
  if (!with_number && !options.value.empty())
    throw UsageError("tell: " + options.verb + " takes no number, got '" + bus::printable(options.value, 40) +
                     "'");
  if (!with_number) return options.verb;
  if (number(options.verb, options.value) < 0)
    throw UsageError("tell: " + options.verb + ": expected a number >= 0");
  return options.verb + " " + options.value;
}

void run(const Options& options) {
  using namespace std::chrono_literals;
  const std::string verb = words(options);
  if (options.to != "*" && !bus::plausible_name(options.to))
    throw UsageError("tell: expected the name of a process, or '*'");
  const bus::Rig rig = options.rig.empty() ? bus::Rig{} : bus::read_rig(options.rig);
  bus::Loop loop(options.url.empty() ? rig.lcm_url : options.url);
  // LCM does not report whether a message was received; every process sends a status once a second
  bool heard = false;
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    heard = heard || ((options.to == "*" || status.name == options.to) && status.state != "ended");
  });
  const auto end = std::chrono::steady_clock::now() + 3s;
  while (!heard && std::chrono::steady_clock::now() < end)
    if (!loop.run_once(50ms)) return;
  if (!heard) throw Error("tell: no process " + (options.to == "*" ? "" : options.to + " ") + "is alive");
  command_t command{};
  command.utime = bus::wall_us();
  command.to = options.to;
  command.verb = verb;
  if (!loop.publish(bus::command_channel, command)) throw Error("tell: " + loop.send_error());
}

}  // namespace

void add_tell(cli::App program) {
  const auto options = std::make_shared<Options>();
  cli::App command =
      program.add_subcommand("tell", "sends a command to a running process: pause, step, seek, reset");
  command.add_option("NAME", options->to, "of the process, e.g. egocal-player; * for all").required();
  command.add_option("VERB", options->verb, "pause, resume, reset; the player also: step, seek S, speed S")
      .check(cli::Check::one_of({"pause", "resume", "reset", "step", "seek", "speed"}))
      .required();
  command.add_option("VALUE", options->value, "of seek: so far into the log [s]; of speed: times real time");
  command.add_option("--rig", options->rig, "rig file, for its LCM URL");
  command.add_option("--lcm-url", options->url, "LCM URL instead of the rig's");
  command.callback([options] { run(*options); });
}

}  // namespace egocal::tools
