// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "commands/commands.hpp"
#include "commands/reading_options.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/printable.hpp"
#include "offline/logs/create_log.hpp"
#include "offline/logs/log_as_mcap.hpp"
#include "offline/logs/log_content.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

struct CreateOptions {
  std::string rig, out;
  ReadOptions reading;
  std::vector<std::string> from;
};

void run_create(const CreateOptions& options) {
  std::vector<SensorFile> from;
  std::set<std::string> given;
  for (const std::string& text : options.from) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      throw UsageError("--from: expected SENSOR=FILE, got '" + text + "'");
    const std::string name = text.substr(0, equals);
    if (!given.insert(name).second) throw UsageError("--from: the sensor " + name + " is given twice");
    from.push_back({name, text.substr(equals + 1)});
  }
  print_warnings(create_log(options.rig, from, options.reading, options.out));
}

constexpr std::size_t most_name = 4096;  // PATH_MAX

void print_info(const std::string& file, bool json) {
  const LogContent content = content_of_log(file);
  if (json) {
    nlohmann::ordered_json object;
    object["file"] = printable(file, most_name);
    object["bytes"] = content.size;
    object["channels"] = nlohmann::ordered_json::array();
    for (const auto& [name, channel] : content.channels)
      object["channels"].push_back({{"channel", printable(name)},
                                    {"type", channel.type},
                                    {"events", channel.events},
                                    {"first_s", to_seconds(channel.first_us)},
                                    {"last_s", to_seconds(channel.last_us)}});
    object["events_of_other_channels"] = content.others.events;
    object["damaged_regions"] = content.damage.regions;
    object["lost_bytes"] = content.damage.bytes;
    object["lost_events"] = content.damage.lost_events;
    object["jumps"] = content.damage.jumps;
    object["truncated"] = content.damage.truncated;
    // names of files and channels may be any bytes, JSON is UTF-8
    using Json = nlohmann::ordered_json;
    fmt::print("{}\n", object.dump(2, ' ', false, Json::error_handler_t::replace));
    return;
  }
  fmt::print("{}: {} bytes, {}\n{:<32} {:<22} {:>9} {:>18} {:>10} {:>9}\n", file, content.size,
             damage_text(content.damage), "channel", "type", "events", "first [s]", "span [s]", "rate [Hz]");
  for (const auto& [name, channel] : content.channels) {
    const double span = to_seconds(channel.last_us - channel.first_us);
    fmt::print("{:<32} {:<22} {:>9} {:>18.3f} {:>10.3f} {:>9.1f}\n", printable(name, 32), channel.type,
               channel.events, to_seconds(channel.first_us), span,
               span > 0 ? static_cast<double>(channel.events - 1) / span : 0.0);
  }
  if (content.more_channels)
    fmt::print("and {} events of more channels than the {} above\n", content.others.events, most_channels);
}

void run_repair(const std::string& file, const std::string& out) {
  const RepairedLog repaired = repair_log(file, out);
  fmt::print("{}: {} events; {}\n", out, repaired.events, damage_text(repaired.damage));
}

void run_log_export(const std::string& file, const std::string& out) {
  const McapOfLog written = log_as_mcap(file, out);
  fmt::print(
      "{}: {}, {}{}; {}\n", out, counted(written.poses, "pose"), counted(written.transforms, "calibration"),
      written.refused > 0 ? fmt::format(", {} refused", written.refused) : "", damage_text(written.damage));
}

void add_create(cli::App log) {
  const auto options = std::make_shared<CreateOptions>();
  cli::App command = log.add_subcommand("create", "trajectories of any format to a log that can be played");
  command.add_option("RIG", options->rig, "rig file: sensors, channels, types").required();
  command.add_option("--from", options->from, "SENSOR=FILE or SENSOR=FILE:TOPIC, once for each sensor")
      .required();
  add_reading_options(command, options->reading);
  command.add_output("--out", options->out, "the log").required();
  command.callback([options] { run_create(*options); });
}

}  // namespace

void add_log(cli::App program) {
  cli::App log = program.add_subcommand("log", "make, look into, check and repair LCM logs");
  log.require_subcommand();
  add_create(log);

  const auto file = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  cli::App info = log.add_subcommand("info", "what is in a log");
  info.add_option("LOG", *file, "an LCM log").required();
  info.add_flag("--json", *json, "one JSON object on standard output");
  info.callback([file, json] { print_info(*file, *json); });

  cli::App check = log.add_subcommand("check", "reads all of a log; fails where it is damaged");
  check.add_option("LOG", *file, "an LCM log").required();
  check.callback([file] {
    const LogContent found = content_of_log(*file);
    if (found.damage.any()) throw error_at(*file, 0, "", damage_text(found.damage));
    fmt::print("{}: {}\n", *file, damage_text(found.damage));
  });

  const auto out = std::make_shared<std::string>();
  cli::App repairing = log.add_subcommand("repair", "all events that can be read, as a new log");
  repairing.add_option("LOG", *file, "an LCM log").required();
  repairing.add_output("--out", *out, "the new log; LOG itself: repaired in place", true).required();
  repairing.callback([file, out] { run_repair(*file, *out); });

  cli::App exported = log.add_subcommand("export", "poses and calibrations of a log for ROS 2 and Foxglove");
  exported.add_option("LOG", *file, "an LCM log").required();
  exported.add_output("--mcap", *out, "the MCAP file").required();
  exported.callback([file, out] { run_log_export(*file, *out); });
}

}  // namespace egocal::tools
