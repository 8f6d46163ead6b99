// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The rig file (TOML, docs/rig.md).
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/datagrams.hpp"
#include "egocal/bus/lcm_url.hpp"
#include "egocal/bus/plausible.hpp"
#include "egocal/bus/recent_pairs.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "toml_table.hpp"

namespace egocal::bus {

namespace {

/// Largest rig file [bytes]. It has a few kilobytes, so a log that is named by mistake is refused at once.
constexpr std::size_t max_file_size = std::size_t{1} << 20;
/// Most dots, as toml++ reads dotted keys by recursion: it crashes at about 50,000 parts, also if they are
/// spread over nested tables. The largest rig has about 4,000 dots.
constexpr std::size_t max_dots_per_line = 1000, max_dots = 20'000;

constexpr Range reorder_window{0, 3600};       // [s]
constexpr Range heartbeat_timeout{1.5, 3600};  // [s]; heartbeats come once a second
constexpr Range sensor_scale{1e-9, 1e9};
constexpr Range goal_rotation_deg{1e-6, 180};  // one standard deviation of a direction
constexpr Range goal_translation{1e-6, 1e3};   // [m]

Sensor read_sensor(const TomlTable& in) {
  in.only({"name", "channel", "type", "plane", "scale"});
  Sensor sensor;
  sensor.name = in.sensor_name("name");
  sensor.channel = in.text("channel");
  if (sensor.channel.empty() || printable(sensor.channel, max_channel_length) != sensor.channel)
    in.fail("channel", "expected 1 to 63 characters that can be printed");
  if (sensor.channel.starts_with("EGOCAL_"))
    in.fail("channel", "names that begin with EGOCAL_ are egocal's own channels");
  if (sensor.channel.find_first_of("*?+|^$\\()[]{}") != std::string::npos)
    in.fail("channel", "expected the name of one channel, not a pattern");
  if (in.has("type") && in.choice("type", {"egocal.odometry_t", "bot_core.pose_t"}) == "bot_core.pose_t")
    sensor.type = OdometryType::pose;
  if (in.has("scale")) {
    sensor.find_scale = in.is_text("scale") && in.text("scale") == "auto";
    if (!sensor.find_scale && in.is_text("scale")) in.fail("scale", "expected a number or \"auto\"");
    if (!sensor.find_scale) sensor.scale = in.number("scale", sensor_scale, "");
  }
  if (in.has("plane")) {
    const std::vector<double> v = in.numbers("plane", 4, "[nx, ny, nz, d]");
    try {
      sensor.plane = validated(GroundPlane{{v[0], v[1], v[2]}, v[3]});
    } catch (const Error& error) {
      in.fail("plane", error.what());
    }
  }
  return sensor;
}

/// goal = "0.1deg,2cm" as --goal takes it, or { rotation_deg = 0.1, translation_m = 0.02 }.
GoalOptions read_goal(const TomlTable& in, const std::string& key) {
  if (in.is_text(key)) {
    const std::optional<GoalOptions> goal = goal_from_text(in.text(key));
    if (!goal) in.fail(key, "expected two accuracies as \"0.1deg,2cm\"");
    return *goal;
  }
  const std::optional<TomlTable> table = in.table(key);
  table->only({"rotation_deg", "translation_m"});
  return {table->number("rotation_deg", goal_rotation_deg, "degrees") * std::numbers::pi / 180,
          table->number("translation_m", goal_translation, "m"), std::nullopt};
}

/// Whether a stride is given. "auto" is the default, and counts as none.
bool gives_stride(const TomlTable& in) {
  return in.has("stride") && !(in.is_text("stride") && in.text("stride") == "auto");
}

/// Reads a and b: two sensors of the rig, at most one of which has an unknown scale.
void read_sensors_of_pair(const TomlTable& in, const Rig& rig, PairConfig& pair) {
  for (const std::string key : {"a", "b"}) {
    const std::string name = in.sensor_name(key);
    const auto known =
        std::find_if(rig.sensors.begin(), rig.sensors.end(), [&](const Sensor& s) { return s.name == name; });
    if (known == rig.sensors.end()) in.fail(key, "no [[sensor]] has the name \"" + name + "\"");
    (key == "a" ? pair.a : pair.b) = name;
  }
  if (pair.a == pair.b) in.fail("b", "is the same sensor as a");
  const bool unscaled_a = sensor(rig, pair.a).find_scale, unscaled_b = sensor(rig, pair.b).find_scale;
  if (unscaled_a && unscaled_b)
    in.fail("b", "both sensors have scale = \"auto\": one of the two must measure metres");
  // the motions of such a pair have a length of their own
  if ((unscaled_a || unscaled_b) && gives_stride(in))
    in.fail("stride", "cannot be chosen where a sensor has scale = \"auto\"");
}

/// Reads stride, weights and time_offset: how the motions are made and weighted.
void read_motion_options(const TomlTable& in, PairConfig& pair) {
  if (gives_stride(in)) {
    const toml::node& node = in.require("stride");
    if (!node.is_integer() || !limits::stride.contains(static_cast<double>(node.as_integer()->get())))
      in.fail("stride", "expected \"auto\" or a whole number from 1 to 10000");
    pair.stride = static_cast<int>(node.as_integer()->get());
  }
  if (in.has("weights")) {
    if (in.is_text("weights")) {
      // equal weights are the paper's plain method, as in `egocal solve`: steps of one, no outlier rejection
      if (in.choice("weights", {"auto", "equal"}) == "equal") {
        pair.balance = Balance{};
        pair.robust = false;
        if (!in.has("stride")) pair.stride = 1;
      }
    } else {
      const std::vector<double> v =
          in.numbers("weights", 2, "[rotation, translation], or \"auto\" or \"equal\"");
      if (v[0] < 0 || v[1] <= 0) in.fail("weights", "expected rotation >= 0 and translation > 0");
      pair.balance = Balance{v[0], v[1]};
    }
  }
  if (in.has("time_offset")) {
    if (in.is_text("time_offset")) {
      if (in.text("time_offset") != "auto") in.fail("time_offset", "expected seconds or \"auto\"");
      pair.time_offset.reset();
    } else {
      pair.time_offset = in.number("time_offset", limits::time_offset, "s");
    }
  }
}

PairConfig read_pair(const TomlTable& in, const Rig& rig) {
  in.only({"a", "b", "mode", "truth", "nominal", "stride", "weights", "time_offset", "goal", "platform",
           "on_move"});
  PairConfig pair;
  read_sensors_of_pair(in, rig, pair);
  if (calibration_channel(pair.a, pair.b).size() > max_channel_length)
    in.fail("b", "the two names together are too long for a channel (63 characters)");
  if (in.has("mode") && in.choice("mode", {"spatial", "planar"}) == "planar") {
    pair.mode = Mode::planar;
    for (const std::string& name : {pair.a, pair.b})
      if (!sensor(rig, name).plane) in.fail("mode", "planar needs the plane of sensor \"" + name + "\"");
  }
  if (in.has("truth")) pair.truth = in.pose("truth");
  if (in.has("nominal")) pair.nominal = in.nominal("nominal");
  read_motion_options(in, pair);
  if (in.has("on_move") && in.choice("on_move", {"report", "restart"}) == "restart")
    pair.on_move = OnMove::restart;
  if (in.has("platform"))
    pair.platform = platform_from_name(in.choice("platform", {"car", "handheld", "drone", "arm"}));
  if (in.has("goal")) {
    pair.goal = read_goal(in, "goal");
    pair.goal->platform = pair.platform;
  }
  return pair;
}

std::string read_url(const TomlTable& bus) {
  std::string url = bus.text("url");
  bool memory = false;
  try {
    memory = parse_lcm_url(url).memory;
  } catch (const Error& error) {
    bus.fail("url", error.what());
  }
  if (memory) bus.fail("url", "expected udpm://GROUP:PORT?ttl=N");
  return url;
}

Rig understood(const toml::table& root, const std::string& file) {
  const TomlTable in(root, "", file);
  in.only({"sensor", "pair", "bus", "pairing", "solver"});
  Rig rig;
  rig.file = file;
  std::set<std::string> names, channels;
  for (const TomlTable& table : in.tables("sensor")) {
    rig.sensors.push_back(read_sensor(table));
    if (!names.insert(rig.sensors.back().name).second)
      table.fail("name", "two sensors have the name \"" + rig.sensors.back().name + "\"");
    if (!channels.insert(rig.sensors.back().channel).second)
      table.fail("channel", "two sensors have the channel \"" + rig.sensors.back().channel + "\"");
  }
  std::set<std::string> pair_channels;
  for (const TomlTable& table : in.tables("pair")) {
    if (rig.pairs.size() == max_pairs)
      table.fail("",
                 "a rig has at most 256 pairs, all of 23 sensors; list those of each sensor with one "
                 "reference, and a few more that close loops");
    rig.pairs.push_back(read_pair(table, rig));
    const PairConfig& pair = rig.pairs.back();
    // a_b with c and a with b_c would share their channels
    if (!pair_channels.insert(problem_channel(pair.a, pair.b)).second)
      table.fail("b", "another pair has the channel " + problem_channel(pair.a, pair.b));
  }
  if (const std::optional<TomlTable> bus = in.table("bus")) {
    bus->only({"url"});
    if (bus->has("url")) rig.lcm_url = read_url(*bus);
  }
  if (const std::optional<TomlTable> pairing = in.table("pairing")) {
    pairing->only({"max_gap", "reorder_window"});
    if (pairing->has("max_gap")) rig.max_gap = pairing->number("max_gap", limits::max_gap, "s");
    if (pairing->has("reorder_window"))
      rig.reorder_window = pairing->number("reorder_window", reorder_window, "s");
  }
  if (const std::optional<TomlTable> solver = in.table("solver")) {
    solver->only({"t_no_fail", "heartbeat_timeout"});
    if (solver->has("t_no_fail")) rig.t_no_fail = solver->number("t_no_fail", limits::t_no_fail, "s");
    if (solver->has("heartbeat_timeout"))
      rig.heartbeat_timeout = solver->number("heartbeat_timeout", heartbeat_timeout, "s");
  }
  return rig;
}

/// Refuses a text that is too large or has too many dots, before toml++ sees it.
void check_size(const std::string& text, const std::string& file) {
  if (text.size() > max_file_size) throw error_at(file, 0, "", "is larger than a rig file can be (1 MiB)");
  long line = 1;
  std::size_t dots = 0, all_dots = 0;
  for (const char c : text) {
    dots += c == '.';
    all_dots += c == '.';
    if (dots > max_dots_per_line)
      throw error_at(file, line, "", "not a rig file: a line with more than 1000 dots");
    if (all_dots > max_dots)
      throw error_at(file, line, "", "not a rig file: more than 20000 dots up to here");
    if (c != '\n') continue;
    ++line;
    dots = 0;
  }
}

}  // namespace

Rig parse_rig(const std::string& text, const std::string& file) {
  check_size(text, file);
  try {
    return understood(toml::parse(text, file), file);
  } catch (const toml::parse_error& error) {
    throw error_at(file, static_cast<long>(error.source().begin.line), "",
                   "not TOML: " + printable(std::string(error.description())));
  }
}

std::string rig_text(const std::string& file) {
  std::error_code none;  // opening the file reports the error
  if (std::filesystem::is_directory(file, none))
    throw error_at(file, 0, "", "is a folder, expected a rig file");
  std::ifstream in(file, std::ios::binary);
  std::string text(max_file_size + 1, '\0');
  if (in.is_open()) in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!in.is_open() || in.bad())
    throw error_at(file, 0, "", std::string("cannot be read as a rig file: ") + std::strerror(errno));
  text.resize(static_cast<std::size_t>(in.gcount()));  // one byte more than a rig can have is refused
  return text;
}

Rig read_rig(const std::string& file) {
  return parse_rig(rig_text(file), file);
}

}  // namespace egocal::bus
