// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/rig.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <numbers>
#include <set>
#include <sstream>
#include <string_view>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/datagrams.hpp"
#include "egocal/bus/lcm_url.hpp"
#include "egocal/bus/plausible.hpp"
#include "egocal/bus/recent_pairs.hpp"
#include "egocal/error.hpp"
#include "egocal/limits.hpp"

namespace egocal::bus {

namespace {

/// A rig file has a few kilobytes; a log that is named by mistake is refused at once [bytes].
constexpr std::size_t max_file_size = std::size_t{1} << 20;
/// toml++ reads dotted keys by recursion and ends with a crash at some 50,000 parts, also where they are
/// spread over tables within tables. The largest rig has some 4,000 dots.
constexpr std::size_t max_dots_per_line = 1000, max_dots = 20'000;

constexpr Range reorder_window{0, 3600};       // [s]
constexpr Range heartbeat_timeout{1.5, 3600};  // [s]; heartbeats come once a second
constexpr Range sensor_scale{1e-9, 1e9};
constexpr Range goal_rotation_deg{1e-6, 180};  // one standard deviation of a direction
constexpr Range goal_translation{1e-6, 1e3};   // [m]

/// One table of the file, with its name for error messages. All its methods throw Error at the line of what
/// they refuse.
class Table {
 public:
  Table(const toml::table& table, std::string name, const std::string& file)
      : table_(table), name_(std::move(name)), file_(file) {}

  [[noreturn]] void fail(const toml::node* node, const std::string& key, const std::string& problem) const {
    const long line = static_cast<long>((node ? node->source() : table_.source()).begin.line);
    const std::string field = name_.empty() ? key : key.empty() ? name_ : name_ + "." + key;
    throw error_at(file_, line, field, problem);
  }
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const {
    fail(table_.get(key), key, problem);
  }

  void only(std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, node] : table_) {
      if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
      std::string known;
      for (const std::string_view k : keys) known += (known.empty() ? "" : ", ") + std::string(k);
      const long line = static_cast<long>(key.source().begin.line);
      throw error_at(file_, line, (name_.empty() ? "" : name_ + ".") + printable(std::string(key.str()), 60),
                     "unknown key; expected one of: " + known);
    }
  }

  bool has(const std::string& key) const { return table_.get(key) != nullptr; }

  const toml::node& require(const std::string& key) const {
    const toml::node* node = table_.get(key);
    if (!node) fail(key, "is missing");
    return *node;
  }

  std::string text(const std::string& key) const {
    const toml::node& node = require(key);
    if (!node.is_string()) fail(key, "expected a text in quotes");
    return node.as_string()->get();
  }

  /// One of these texts.
  std::string choice(const std::string& key, std::initializer_list<std::string_view> choices) const {
    std::string value = text(key);
    if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
      std::string known;
      for (const std::string_view c : choices)
        known += (known.empty() ? "\"" : ", \"") + std::string(c) + "\"";
      fail(key, "expected one of " + known + ", got \"" + printable(value, 60) + "\"");
    }
    return value;
  }

  double number(const std::string& key, const Range& range, const std::string& unit) const {
    return number(require(key), key, range.least, range.most, unit);
  }

  double number(const toml::node& node, const std::string& key, double least, double most,
                const std::string& unit) const {
    const std::optional<double> value = node.is_number() ? node.value<double>() : std::optional<double>{};
    if (!value || !(*value >= least && *value <= most)) {
      std::ostringstream expected;
      expected << "expected a number from " << least << " to " << most << (unit.empty() ? "" : " ") << unit;
      fail(&node, key, expected.str());
    }
    return *value;
  }

  std::vector<double> numbers(const std::string& key, std::size_t count, const std::string& meaning) const {
    const toml::node& node = require(key);
    const toml::array* array = node.as_array();
    if (!array || array->size() != count)
      fail(key, "expected " + std::to_string(count) + " numbers " + meaning);
    std::vector<double> values;
    for (const toml::node& element : *array)
      values.push_back(number(element, key, -limits::largest_distance, limits::largest_distance, ""));
    return values;
  }

  Pose pose(const std::string& key) const {
    const std::vector<double> v = numbers(key, 7, "[x, y, z, qw, qx, qy, qz]");
    Pose pose{{v[3], v[4], v[5], v[6]}, {v[0], v[1], v[2]}};
    if (!plausible_norm(pose.rotation.norm()))
      fail(key, "the quaternion (qw, qx, qy, qz) is not of unit length");
    pose.rotation.normalize();
    return pose;
  }

  std::string sensor_name(const std::string& key) const {
    std::string value = text(key);
    if (!plausible_name(value)) fail(key, "expected 1 to 40 letters, digits, _ or -");
    return value;
  }

  /// The tables of [[key]].
  std::vector<Table> tables(const std::string& key) const {
    const toml::array* array = require(key).as_array();
    if (!array || array->empty()) fail(key, "expected [[" + key + "]] sections");
    std::vector<Table> tables;
    for (std::size_t i = 0; i < array->size(); ++i) {
      const toml::table* table = array->get(i)->as_table();
      if (!table) fail(array->get(i), key, "expected [[" + key + "]] sections");
      tables.emplace_back(*table, key + "[" + std::to_string(i + 1) + "]", file_);
    }
    return tables;
  }

  std::optional<Table> table(const std::string& key) const {
    const toml::node* node = table_.get(key);
    if (!node) return std::nullopt;
    if (!node->is_table()) fail(key, "expected a table");
    return Table(*node->as_table(), name_.empty() ? key : name_ + "." + key, file_);
  }

 private:
  const toml::table& table_;
  std::string name_;
  const std::string& file_;
};

Sensor read_sensor(const Table& in) {
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
    sensor.find_scale = in.require("scale").is_string() && in.text("scale") == "auto";
    if (!sensor.find_scale && in.require("scale").is_string())
      in.fail("scale", "expected a number or \"auto\"");
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
GoalOptions read_goal(const Table& in, const std::string& key) {
  if (in.require(key).is_string()) {
    const std::optional<GoalOptions> goal = goal_from_text(in.text(key));
    if (!goal) in.fail(key, "expected two accuracies as \"0.1deg,2cm\"");
    return *goal;
  }
  const std::optional<Table> table = in.table(key);
  table->only({"rotation_deg", "translation_m"});
  return {table->number("rotation_deg", goal_rotation_deg, "degrees") * std::numbers::pi / 180,
          table->number("translation_m", goal_translation, "m"), std::nullopt};
}

PairConfig read_pair(const Table& in, const Rig& rig) {
  in.only({"a", "b", "mode", "truth", "nominal", "stride", "weights", "time_offset", "goal", "platform",
           "on_move"});
  PairConfig pair;
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
  if ((unscaled_a || unscaled_b) && in.has("stride"))
    in.fail("stride", "cannot be chosen where a sensor has scale = \"auto\"");
  if (calibration_channel(pair.a, pair.b).size() > max_channel_length)
    in.fail("b", "the two names together are too long for a channel (63 characters)");
  if (in.has("mode") && in.choice("mode", {"spatial", "planar"}) == "planar") {
    pair.mode = Mode::planar;
    for (const std::string& name : {pair.a, pair.b})
      if (!sensor(rig, name).plane) in.fail("mode", "planar needs the plane of sensor \"" + name + "\"");
  }
  if (in.has("truth")) pair.truth = in.pose("truth");
  if (in.has("nominal")) pair.nominal = in.pose("nominal");
  if (in.has("stride") && !(in.require("stride").is_string() && in.text("stride") == "auto")) {
    const toml::node& node = in.require("stride");
    if (!node.is_integer() || !limits::stride.contains(static_cast<double>(node.as_integer()->get())))
      in.fail("stride", "expected \"auto\" or a whole number from 1 to 10000");
    pair.stride = static_cast<int>(node.as_integer()->get());
  }
  if (in.has("weights")) {
    if (in.require("weights").is_string()) {
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
    if (in.require("time_offset").is_string()) {
      if (in.text("time_offset") != "auto") in.fail("time_offset", "expected seconds or \"auto\"");
      pair.time_offset.reset();
    } else {
      pair.time_offset = in.number("time_offset", limits::time_offset, "s");
    }
  }
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

std::string read_url(const Table& bus) {
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
  const Table in(root, "", file);
  in.only({"sensor", "pair", "bus", "pairing", "solver"});
  Rig rig;
  rig.file = file;
  std::set<std::string> names, channels;
  for (const Table& table : in.tables("sensor")) {
    rig.sensors.push_back(read_sensor(table));
    if (!names.insert(rig.sensors.back().name).second)
      table.fail("name", "two sensors have the name \"" + rig.sensors.back().name + "\"");
    if (!channels.insert(rig.sensors.back().channel).second)
      table.fail("channel", "two sensors have the channel \"" + rig.sensors.back().channel + "\"");
  }
  std::set<std::string> pair_channels;
  for (const Table& table : in.tables("pair")) {
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
  if (const std::optional<Table> bus = in.table("bus")) {
    bus->only({"url"});
    if (bus->has("url")) rig.lcm_url = read_url(*bus);
  }
  if (const std::optional<Table> pairing = in.table("pairing")) {
    pairing->only({"max_gap", "reorder_window"});
    if (pairing->has("max_gap")) rig.max_gap = pairing->number("max_gap", limits::max_gap, "s");
    if (pairing->has("reorder_window"))
      rig.reorder_window = pairing->number("reorder_window", reorder_window, "s");
  }
  if (const std::optional<Table> solver = in.table("solver")) {
    solver->only({"t_no_fail", "heartbeat_timeout"});
    if (solver->has("t_no_fail")) rig.t_no_fail = solver->number("t_no_fail", limits::t_no_fail, "s");
    if (solver->has("heartbeat_timeout"))
      rig.heartbeat_timeout = solver->number("heartbeat_timeout", heartbeat_timeout, "s");
  }
  return rig;
}

/// Before toml++ sees the text.
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
  std::error_code none;  // what cannot be looked at cannot be opened either, which is said below
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

const Sensor& sensor(const Rig& rig, const std::string& name) {
  for (const Sensor& s : rig.sensors)
    if (s.name == name) return s;
  throw error_at(rig.file, 0, "", "no sensor has the name \"" + name + "\"");
}

namespace {

/// The pairs of a rig estimate their clocks and choose their weights one after the other.
double phase_of(const Rig& rig, const PairConfig& pair) {
  double before = 0;
  for (const PairConfig& other : rig.pairs) {
    if (other.a == pair.a && other.b == pair.b) return before / static_cast<double>(rig.pairs.size());
    before += 1;
  }
  return 0;
}

}  // namespace

PairingOptions drive_options(const Rig& rig, const PairConfig& pair) {
  PairingOptions options;
  options.mode = pair.mode;
  if (pair.mode == Mode::planar) {
    options.plane_a = sensor(rig, pair.a).plane.value_or(GroundPlane{});
    options.plane_b = sensor(rig, pair.b).plane.value_or(GroundPlane{});
  }
  options.stride = pair.stride;
  options.balance = pair.balance;
  options.time_offset = pair.time_offset.value_or(0);
  options.track_time_offset = !pair.time_offset;
  options.robust = pair.robust;
  options.max_gap = rig.max_gap;
  if (pair.nominal) options.prior = to_dual_quaternion(*pair.nominal);
  options.clock.phase = options.accumulator.choice_phase = phase_of(rig, pair);
  return options;
}

StreamOptions stream_options(const Rig& rig) {
  StreamOptions options;
  options.reorder_window = rig.reorder_window;
  return options;
}

std::optional<Side> unscaled_side(const Rig& rig, const PairConfig& pair) {
  for (const Sensor& s : rig.sensors)
    if (s.find_scale && (s.name == pair.a || s.name == pair.b)) return s.name == pair.a ? Side::a : Side::b;
  return std::nullopt;
}

}  // namespace egocal::bus
