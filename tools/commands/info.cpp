// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "commands/commands.hpp"
#include "commands/reading_options.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/degrees.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/io/stream_summary.hpp"
#include "egocal/microseconds.hpp"
#include "offline/printing/provenance.hpp"
#include "offline/reading/either_way_summary.hpp"
#include "offline/reading/trajectory_source.hpp"

namespace egocal::tools {

namespace {

using nlohmann::ordered_json;

struct InfoOptions {
  std::string name;
  ReadOptions reading;
  bool json = false;
};

/// One stream with what its poses show.
struct Row {
  RecordedStream stream;
  StreamSummary summary;
};

struct Contents {
  std::vector<Row> rows;
  std::string format;
  ReadLosses losses;
  std::vector<std::string> notes;
};

/// Refuses repairs, as the commands that use the poses do.
void refuse_repairs_of(const std::string& name, const Contents& contents) {
  if (contents.losses.any()) throw error_at(name, 0, "", losses_in_words(contents.losses));
  for (const Row& row : contents.rows)
    if (row.summary.out_of_order > 0)
      throw error_at(name, 0, row.stream.name,
                     counted(row.summary.out_of_order, "time") +
                         " not later than the one before it, expected increasing times");
}

/// One pass over the file; of a chain of transforms the resolved poses.
Contents read_contents(const InfoOptions& options) {
  const RecordingName name = parse_recording_name(options.name);
  const std::unique_ptr<Recording> recording = open_any_recording(name.file, options.reading);
  Contents contents;
  if (!name.topic.empty()) {
    const TrajectoryReading trajectory = read_trajectory_of(*recording, name.topic);
    StreamSummariser summariser;
    for (const StampedPose& pose : trajectory.trajectory) summariser.add(pose);
    Row row;
    row.stream.name = trajectory.stream;
    for (const RecordedStream& stream : recording->streams())
      if (stream.name == trajectory.stream) row.stream = stream;
    row.stream.poses = true;
    row.summary = summariser.summary();
    row.summary.out_of_order = trajectory.out_of_order + trajectory.duplicates;
    contents.rows.push_back(std::move(row));
    contents.notes = trajectory.notes;
  } else {
    std::vector<EitherWaySummariser> summarisers;
    recording->read("", [&](std::size_t stream, const StampedPose& pose) {
      if (stream >= summarisers.size()) summarisers.resize(stream + 1);
      summarisers[stream].add(pose);
    });
    summarisers.resize(recording->streams().size());
    for (std::size_t i = 0; i < summarisers.size(); ++i)
      contents.rows.push_back({recording->streams()[i], summarisers[i].summary()});
    contents.notes = recording->notes();
    for (const Row& row : contents.rows)
      if (!row.stream.mixed.empty()) contents.notes.push_back(row.stream.name + ": " + row.stream.mixed);
  }
  for (const std::string& unused : recording->unused(options.reading)) contents.notes.push_back(unused);
  contents.format = recording->format();
  contents.losses = recording->losses();
  if (options.reading.strict) refuse_repairs_of(options.name, contents);
  return contents;
}

ordered_json row_json(const Row& row) {
  const auto& [stream, summary] = row;
  ordered_json object{{"name", bus::printable(stream.name)},
                      {"type", bus::printable(stream.type)},
                      {"messages", stream.messages},
                      {"has_poses", stream.poses}};
  if (!stream.parent.empty()) object["parent"] = bus::printable(stream.parent);
  if (!stream.child.empty()) object["child"] = bus::printable(stream.child);
  if (stream.fixed) object["static"] = true;
  object["poses"] = summary.poses;
  if (summary.poses == 0) return object;
  object["first_s"] = to_seconds(summary.first_us);
  object["last_s"] = to_seconds(summary.last_us);
  object["span_s"] = to_seconds(summary.last_us - summary.first_us);
  object["rate_hz"] = summary.rate;
  object["path_length_m"] = summary.path_length;
  object["turning_rad"] = summary.turning;
  object["gaps"] = summary.gaps;
  object["longest_gap_s"] = summary.longest_gap;
  object["jumps"] = summary.jumps;
  object["times_not_increasing"] = summary.out_of_order;
  return object;
}

void print_json(const InfoOptions& options, const Contents& contents, const std::string& command_line) {
  ordered_json object = provenance_json(command_line);
  object["file"] = bus::printable(options.name);
  object["format"] = contents.format;
  object["streams"] = ordered_json::array();
  for (const Row& row : contents.rows) object["streams"].push_back(row_json(row));
  object["damaged_regions"] = contents.losses.regions;
  object["lost_bytes"] = contents.losses.bytes;
  object["truncated"] = contents.losses.truncated;
  object["checksum_differs"] = contents.losses.checksum;
  object["refused"] = contents.losses.refused;
  object["notes"] = contents.notes;
  if (contents.losses.parts > 0) {
    ReadLosses parts;
    parts.parts = contents.losses.parts;
    parts.first_part = contents.losses.first_part;
    object["notes"].push_back(losses_in_words(parts));
  }
  fmt::print("{}\n", object.dump(2, ' ', false, ordered_json::error_handler_t::replace));
}

/// A text of the file, with dots where it is cut.
std::string shown(const std::string& text, std::size_t longest) {
  return bus::printable(text, longest) + (text.size() > longest ? "..." : "");
}

void print_row(const Row& row) {
  const auto& [stream, summary] = row;
  // the name is what the next command is given
  constexpr std::size_t longest_name = 1000, longest_word = 100;  // limits of what people read [bytes]
  const std::string name = stream.name.empty() ? "(the only stream)" : shown(stream.name, longest_name);
  fmt::print("\n{}  {}, {}{}\n", name, shown(stream.type, longest_word), counted(stream.messages, "message"),
             stream.fixed ? ", static" : "");
  if (!stream.poses || stream.fixed) return;
  if (summary.poses == 0) {
    fmt::print("  no usable pose\n");
    return;
  }
  if (!stream.child.empty())
    fmt::print("  pose of         {} in {}\n", shown(stream.child, longest_word),
               shown(stream.parent, longest_word));
  fmt::print("  poses           {} at {:.1f} Hz\n", summary.poses, summary.rate);
  fmt::print("  time            {:.3f} to {:.3f} s, {:.3f} s\n", to_seconds(summary.first_us),
             to_seconds(summary.last_us), to_seconds(summary.last_us - summary.first_us));
  fmt::print("  path length     {:.1f} m\n", summary.path_length);
  fmt::print("  turning         {:.0f} {:.0f} {:.0f} deg about x y z of the sensor\n",
             summary.turning[0] * degrees_per_radian, summary.turning[1] * degrees_per_radian,
             summary.turning[2] * degrees_per_radian);
  if (summary.gaps > 0)
    fmt::print("  gaps            {}, the longest {:.3f} s\n", summary.gaps, summary.longest_gap);
  if (summary.jumps > 0) fmt::print("  jumps           {} (above 70 m/s or 15 rad/s)\n", summary.jumps);
  if (summary.out_of_order > 0)
    fmt::print("  order           {} times do not increase\n", summary.out_of_order);
}

void run_info(const InfoOptions& options, const std::string& command_line) {
  const Contents contents = read_contents(options);
  if (options.json) return print_json(options, contents, command_line);
  fmt::print("{}: {}, {}\n", bus::printable(options.name), contents.format,
             counted(contents.rows.size(), "stream"));
  for (const std::string& note : contents.notes) fmt::print("note: {}\n", note);
  if (contents.losses.any()) fmt::print("lost: {}\n", losses_in_words(contents.losses));
  for (const Row& row : contents.rows) print_row(row);
}

}  // namespace

void add_info(cli::App program) {
  const auto options = std::make_shared<InfoOptions>();
  cli::App command = program.add_subcommand("info", "what a recording holds: streams, poses, gaps, jumps");
  command.add_option("FILE", options->name, "any recording: FILE, or FILE:TOPIC for one stream").required();
  add_reading_options(command, options->reading);
  command.add_flag("--json", options->json, "one JSON object on standard output");
  command.callback([options, command] { run_info(*options, command.command_line()); });
}

}  // namespace egocal::tools
