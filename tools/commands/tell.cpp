// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "arguments.hpp"
#include "commands/commands.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/process.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "warnings.hpp"

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

/// What is heard of the process that is addressed, and of a diagnosis that may be it.
struct Heard {
  bool obeys = false;
  std::optional<std::string> ignores{};  ///< the role of one that does not know the verb
  bool pairing = false, diagnosis = false;
};

void hear(const status_t& status, const TellOptions& options, Heard& heard) {
  if (status.state == "ended") return;
  const std::optional<bus::Role> role = bus::role_from_name(status.role);
  heard.pairing = heard.pairing || role == bus::Role::pairing;
  heard.diagnosis = heard.diagnosis || role == bus::Role::diagnosis;
  if (options.to != "*" && status.name != options.to) return;
  // what a role of another version knows is not known here
  if (!role || bus::knows_verb(*role, options.verb))
    heard.obeys = true;
  else
    heard.ignores = status.role;
}

/// Whether the process that is addressed may be a diagnosis that computes, which is silent for as long as it
/// has announced before we listened: problems are made that one would judge, none was heard, and the name is
/// not that of another program.
bool may_compute(const TellOptions& options, const Heard& heard) {
  if (options.to == "*" || !heard.pairing || heard.diagnosis) return false;
  for (const bus::Role other :
       {bus::Role::player, bus::Role::pairing, bus::Role::fast, bus::Role::global, bus::Role::monitor})
    if (options.to == "egocal-" + std::string(bus::role_name(other))) return false;
  return bus::knows_verb(bus::Role::diagnosis, options.verb);
}

/// Listens until it is known whether the command is obeyed. LCM does not report whether a message was
/// received; every process sends a status once a second, but for one that computes.
void listen_for(const TellOptions& options, bus::Loop& loop, Heard& heard) {
  using namespace std::chrono_literals;
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    hear(status, options, heard);
  });
  const auto begin = std::chrono::steady_clock::now();
  bool said = false;
  while (!heard.obeys && !(heard.ignores && options.to != "*")) {
    const auto passed = std::chrono::steady_clock::now() - begin;
    if (passed > 3s) {
      if (!may_compute(options, heard) || passed > bus::longest_announced_silence) break;
      if (!std::exchange(said, true))
        say(
            fmt::format("egocal: {} is not heard: waiting, as a diagnosis that computes is silent for up to "
                        "{} s",
                        options.to, bus::longest_announced_silence.count()));
    }
    if (!loop.run_once(50ms)) throw cli::Exit{1};
  }
}

void run_tell(const TellOptions& options) {
  const std::string verb = words(options);
  if (options.to != "*" && !bus::plausible_name(options.to))
    throw UsageError("tell: expected the name of a process, or '*'");
  const bus::Rig rig = options.rig.empty() ? bus::Rig{} : bus::read_rig(options.rig);
  Heard heard;  // as long as the loop, which fills it
  bus::Loop loop(options.url.empty() ? rig.lcm_url : options.url);
  listen_for(options, loop, heard);
  if (!heard.obeys && heard.ignores) throw Error("tell: " + refusal(options, *heard.ignores));
  if (!heard.obeys)
    throw Error("tell: no process " + (options.to == "*" ? "" : options.to + " ") + "is alive");
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
