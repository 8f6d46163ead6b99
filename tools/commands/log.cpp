// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "arguments.hpp"
#include "commands/commands.hpp"
#include "commands/reading_options.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/io/mcap_writer.hpp"
#include "egocal/microseconds.hpp"
#include "offline/reading/lcm_pose.hpp"
#include "offline/reading/trajectory_source.hpp"
#include "progress.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

struct CreateOptions {
  std::string rig, out;
  ReadOptions reading;
  std::vector<std::string> from;
};

void create(const CreateOptions& options) {
  const bus::Rig rig = bus::read_rig(options.rig);
  struct Entry {
    std::int64_t time_us;
    const bus::Sensor* sensor;
    std::int64_t seq;
    const StampedPose* pose;
  };
  std::vector<Trajectory> trajectories(options.from.size());
  std::vector<Entry> entries;
  std::vector<std::string> warnings;
  std::set<std::string> given;
  for (std::size_t k = 0; k < options.from.size(); ++k) {
    const std::string& text = options.from[k];
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      throw UsageError("--from: expected SENSOR=FILE, got '" + text + "'");
    const std::string name = text.substr(0, equals);
    if (!given.insert(name).second) throw UsageError("--from: the sensor " + name + " is given twice");
    const bus::Sensor& sensor = bus::sensor(rig, name);
    trajectories[k] = read_noting(text.substr(equals + 1), options.reading, warnings);
    for (std::size_t i = 0; i < trajectories[k].size(); ++i)
      entries.push_back(
          {trajectories[k][i].time_us, &sensor, static_cast<std::int64_t>(i), &trajectories[k][i]});
  }
  for (const bus::Sensor& sensor : rig.sensors)
    if (!given.contains(sensor.name))
      warnings.push_back("no --from of the sensor " + sensor.name + ": its channel " + sensor.channel +
                         " is not in the log");
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& x, const Entry& y) { return x.time_us < y.time_us; });
  // Times that begin near zero are no dates; on the wire they must be plausible ones.
  const std::int64_t shift =
      bus::plausible_time(entries.front().time_us) ? 0 : 1'700'000'000'000'000 - entries.front().time_us;
  bus::LogWriter log(options.out);
  Progress progress("writing");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    StampedPose pose = *entries[i].pose;
    pose.time_us += shift;
    if (entries[i].sensor->type == bus::OdometryType::pose)
      log.write(pose.time_us, entries[i].sensor->channel, bus::encode(bus::to_pose_message(pose)));
    else
      log.write(pose.time_us, entries[i].sensor->channel, bus::encode(bus::to_message(pose, entries[i].seq)));
    progress(static_cast<double>(i + 1) / static_cast<double>(entries.size()));
  }
  log.close();
  if (shift != 0)
    warnings.push_back(
        fmt::format("times do not begin after 1970; {:.3f} s were added to all of them", to_seconds(shift)));
  print_warnings(warnings);
}

constexpr std::size_t most_name = 4096;  // PATH_MAX

struct Channel {
  std::uint64_t count = 0, bytes = 0;
  std::int64_t first_us = 0, last_us = 0;
  std::string type;
};

/// A limit on memory: a damaged or hostile log may hold a million channels.
constexpr std::size_t most_channels = 1000;

struct Info {
  std::map<std::string, Channel> channels;
  Channel others;  ///< events of channels beyond those
  bool more_channels = false;
  bus::LogDamage damage;
  std::uint64_t size = 0;
};

Info inspect(const std::string& file) {
  bus::LogReader log(file);
  Info info;
  info.size = log.size();
  Progress progress("reading");
  while (const auto event = log.next()) {
    const bool shown = info.channels.size() < most_channels || info.channels.contains(event->channel);
    if (!shown) info.more_channels = true;
    Channel& channel = shown ? info.channels[event->channel] : info.others;
    if (channel.count++ == 0) {
      channel.first_us = event->time_us;
      const std::string known = decode_lcm_pose(event->data).type;  // the ROS-shaped types as well
      channel.type = known.empty() ? bus::type_name(event->data) : known;
    }
    channel.last_us = event->time_us;
    channel.bytes += event->data.size();
    progress(static_cast<double>(log.position()) / static_cast<double>(log.size()));
  }
  info.damage = log.damage();
  return info;
}

std::string damage_text(const bus::LogDamage& damage) {
  if (!damage.any()) return "no damage";
  std::string text;
  if (damage.regions > 0)
    text = fmt::format("{}, {} and at least {} lost", counted(damage.regions, "damaged region"),
                       counted(damage.bytes, "byte"), counted(damage.lost_events, "event"));
  if (damage.jumps > 0)
    text += fmt::format(
        "{}the numbers of the events jump at {}{}", text.empty() ? "" : "; ", counted(damage.jumps, "place"),
        damage.regions > 0 ? "" : fmt::format(", {} missing", counted(damage.lost_events, "event")));
  return text + (damage.truncated ? "; cut off at the end" : "");
}

void print_info(const std::string& file, bool json) {
  const Info info = inspect(file);
  if (json) {
    nlohmann::ordered_json object;
    object["file"] = bus::printable(file, most_name);
    object["bytes"] = info.size;
    object["channels"] = nlohmann::ordered_json::array();
    for (const auto& [name, channel] : info.channels)
      object["channels"].push_back({{"channel", bus::printable(name)},
                                    {"type", channel.type},
                                    {"events", channel.count},
                                    {"first_s", to_seconds(channel.first_us)},
                                    {"last_s", to_seconds(channel.last_us)}});
    object["events_of_other_channels"] = info.others.count;
    object["damaged_regions"] = info.damage.regions;
    object["lost_bytes"] = info.damage.bytes;
    object["lost_events"] = info.damage.lost_events;
    object["jumps"] = info.damage.jumps;
    object["truncated"] = info.damage.truncated;
    // names of files and channels may be any bytes, JSON is UTF-8
    using Json = nlohmann::ordered_json;
    fmt::print("{}\n", object.dump(2, ' ', false, Json::error_handler_t::replace));
    return;
  }
  fmt::print("{}: {} bytes, {}\n{:<32} {:<22} {:>9} {:>18} {:>10} {:>9}\n", file, info.size,
             damage_text(info.damage), "channel", "type", "events", "first [s]", "span [s]", "rate [Hz]");
  for (const auto& [name, channel] : info.channels) {
    const double span = to_seconds(channel.last_us - channel.first_us);
    fmt::print("{:<32} {:<22} {:>9} {:>18.3f} {:>10.3f} {:>9.1f}\n", bus::printable(name, 32), channel.type,
               channel.count, to_seconds(channel.first_us), span,
               span > 0 ? static_cast<double>(channel.count - 1) / span : 0.0);
  }
  if (info.more_channels)
    fmt::print("and {} events of more channels than the {} above\n", info.others.count, most_channels);
}

void repair(const std::string& file, const std::string& out) {
  bus::LogReader log(file);
  bus::LogWriter repaired(out);
  Progress progress("writing");
  std::uint64_t events = 0;
  while (const auto event = log.next()) {
    repaired.write(event->time_us, event->channel, event->data);
    ++events;
    progress(static_cast<double>(log.position()) / static_cast<double>(log.size()));
  }
  repaired.close();
  fmt::print("{}: {} events; {}\n", out, events, damage_text(log.damage()));
}

/// Solvers send their answer again once a second: the pair's last one is written once.
class NewAnswers {
 public:
  bool is_new(const calibration_t& answer) {
    const Sent sent{answer.session,
                    answer.seq,
                    answer.utime,
                    {answer.pos, answer.pos + 3},
                    {answer.quat, answer.quat + 4}};
    const auto [last, first] = last_.try_emplace({answer.sensor_a, answer.sensor_b, answer.solver}, sent);
    if (first) return true;
    return std::exchange(last->second, sent) != sent;
  }

 private:
  using Sent = std::tuple<std::int64_t, std::int64_t, std::int64_t, std::vector<double>, std::vector<double>>;
  std::map<std::array<std::string, 3>, Sent> last_;
};

/// Poses of every channel as topics and transforms, calibrations as transforms: for ROS 2 and Foxglove. All
/// at the times of the drive, which may have been played and recorded on another day.
void export_mcap(const std::string& file, const std::string& out) {
  bus::LogReader log(file);
  McapWriter mcap(out);
  Progress progress("writing");
  std::uint64_t poses = 0, transforms = 0, refused = 0;
  NewAnswers answers;
  while (const auto event = log.next()) {
    const std::string name = bus::printable(event->channel, 63);
    calibration_t calibration{};
    if (const LcmPose message = decode_lcm_pose(event->data, event->time_us); !message.type.empty()) {
      if (!message.pose) {
        ++refused;
        continue;
      }
      mcap.write_pose("/" + name, name + "_start", *message.pose.value);
      mcap.write_transform(name + "_start", name, *message.pose.value);
      ++poses;
    } else if (bus::decode(event->data, calibration)) {
      const bus::Checked<Answer> answer = bus::to_answer(calibration);
      if (!answer) {
        ++refused;
        continue;
      }
      if (!answers.is_new(calibration)) continue;
      mcap.write_transform(bus::printable(calibration.sensor_a, 63), bus::printable(calibration.sensor_b, 63),
                           {calibration.utime, answer.value->T_a_b});
      ++transforms;
    }
    progress(static_cast<double>(log.position()) / static_cast<double>(log.size()));
  }
  if (poses + transforms == 0) throw error_at(file, 0, "", "holds neither poses nor calibrations");
  mcap.close();
  fmt::print("{}: {}, {}{}; {}\n", out, counted(poses, "pose"), counted(transforms, "calibration"),
             refused > 0 ? fmt::format(", {} refused", refused) : "", damage_text(log.damage()));
}

void add_create(cli::App log) {
  const auto options = std::make_shared<CreateOptions>();
  cli::App command = log.add_subcommand("create", "trajectories of any format to a log that can be played");
  command.add_option("RIG", options->rig, "rig file: sensors, channels, types").required();
  command.add_option("--from", options->from, "SENSOR=FILE or SENSOR=FILE:TOPIC, once for each sensor")
      .required();
  add_reading_options(command, options->reading);
  command.add_output("--out", options->out, "the log").required();
  command.callback([options] { create(*options); });
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
    const Info found = inspect(*file);
    if (found.damage.any()) throw error_at(*file, 0, "", damage_text(found.damage));
    fmt::print("{}: {}\n", *file, damage_text(found.damage));
  });

  const auto out = std::make_shared<std::string>();
  cli::App repairing = log.add_subcommand("repair", "all events that can be read, as a new log");
  repairing.add_option("LOG", *file, "an LCM log").required();
  repairing.add_output("--out", *out, "the new log; LOG itself: repaired in place", true).required();
  repairing.callback([file, out] { repair(*file, *out); });

  cli::App exported = log.add_subcommand("export", "poses and calibrations of a log for ROS 2 and Foxglove");
  exported.add_option("LOG", *file, "an LCM log").required();
  exported.add_output("--mcap", *out, "the MCAP file").required();
  exported.callback([file, out] { export_mcap(*file, *out); });
}

}  // namespace egocal::tools
