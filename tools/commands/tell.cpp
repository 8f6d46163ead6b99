// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "arguments.hpp"
#include "commands/commands.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/process.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"

namespace egocal::tools {

namespace {

struct TellOptions {
  std::string to, verb, value, rig, url;
};

/// What goes into the message: the verb, with its number where it has one.
std::string words(const TellOptions& options) {
  const bool with_number = options.verb == "seek" || options.verb == "speed";
  if (!with_number && !options.value.empty())
    throw UsageError("tell: " + options.verb + " takes no number, got '" + bus::printable(options.value, 40) +
                     "'");
  if (!with_number) return options.verb;
  if (options.value.empty() || number("tell: " + options.verb, options.value) < 0)
    throw UsageError("tell: " + options.verb + ": expected a number from 0 up, got '" +
                     bus::printable(options.value, 40) + "'");
  return options.verb + " " + options.value;
}

/// Why the process that was addressed does nothing on this verb, and who would.
std::string refusal(const TellOptions& options, const std::string& role) {
  std::string who;
  for (const bus::Role known :
       {bus::Role::player, bus::Role::pairing, bus::Role::fast, bus::Role::global, bus::Role::diagnosis})
    if (bus::knows_verb(known, options.verb))
      who += (who.empty() ? "" : ", ") + ("egocal-" + std::string(bus::role_name(known)));
  if (options.to == "*") return "no process that is alive knows " + options.verb + "; these do: " + who;
  const std::string verbs = bus::verbs_of(*bus::role_from_name(role));
  return options.to + " (" + role + ") does not know " + options.verb + "; these do: " + who + "; it knows " +
         (verbs.empty() ? "no command" : verbs);
}

void run_tell(const TellOptions& options) {
  using namespace std::chrono_literals;
  const std::string verb = words(options);
  if (options.to != "*" && !bus::plausible_name(options.to))
    throw UsageError("tell: expected the name of a process, or '*'");
  const bus::Rig rig = options.rig.empty() ? bus::Rig{} : bus::read_rig(options.rig);
  bus::Loop loop(options.url.empty() ? rig.lcm_url : options.url);
  // LCM does not report whether a message was received; every process sends a status once a second
  bool obeys = false;
  std::optional<std::string> heard;  // the role of one that ignores the verb
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    if ((options.to != "*" && status.name != options.to) || status.state == "ended") return;
    const std::optional<bus::Role> role = bus::role_from_name(status.role);
    // what a role of another version knows is not known here
    if (!role || bus::knows_verb(*role, options.verb))
      obeys = true;
    else
      heard = status.role;
  });
  const auto end = std::chrono::steady_clock::now() + 3s;
  while (!obeys && !(heard && options.to != "*") && std::chrono::steady_clock::now() < end)
    if (!loop.run_once(50ms)) return;
  if (!obeys && heard) throw Error("tell: " + refusal(options, *heard));
  if (!obeys) throw Error("tell: no process " + (options.to == "*" ? "" : options.to + " ") + "is alive");
  command_t command{};
  command.utime = bus::wall_us();
  command.to = options.to;
  command.verb = verb;
  if (!loop.publish(bus::command_channel, command)) throw Error("tell: " + loop.send_error());
}

}  // namespace

void add_tell(cli::App program) {
  const auto options = std::make_shared<TellOptions>();
  cli::App command =
      program.add_subcommand("tell", "sends a command to a running process: pause, step, seek, reset");
  command.add_option("NAME", options->to, "of the process, e.g. egocal-player; * for all").required();
  command.add_option("VERB", options->verb, "pause, resume, reset; the player also: step, seek S, speed S")
      .check(cli::Check::one_of({"pause", "resume", "reset", "step", "seek", "speed"}))
      .required();
  command.add_option("VALUE", options->value, "of seek: so far into the log [s]; of speed: times real time");
  command.add_option("--rig", options->rig, "rig file, for its LCM URL");
  command.add_option("--lcm-url", options->url, "LCM URL instead of the rig's");
  command.callback([options] { run_tell(*options); });
}

}  // namespace egocal::tools
