// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/solve_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "arguments.hpp"
#include "egocal/io/whole_file.hpp"
#include "offline/extrinsics/tree_of_rig.hpp"
#include "offline/printing/provenance.hpp"
#include "offline/printing/rig.hpp"
#include "progress.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

/// "lidar" of "drive/lidar.tum"; "drive.mcap:/lidar" as it is.
std::string short_name(const std::string& source) {
  if (!std::filesystem::is_regular_file(source)) return source;
  const std::string stem = std::filesystem::path(source).stem().string();
  return stem.empty() ? source : stem;
}

/// Short names of files, where they are all different.
std::vector<std::string> names_of(const std::vector<std::string>& sources, bool files) {
  if (!files) return sources;
  std::vector<std::string> names;
  names.reserve(sources.size());
  for (const std::string& source : sources) names.push_back(short_name(source));
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() ? names : sources;
}

void refuse_options_of_two(const RequestOptions& typed) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw UsageError(std::string(option) + ": goes with two sensors, not with more or --rig");
  };
  refuse(!typed.source.pairs.empty(), "--pairs");
  refuse(typed.samples || typed.eye_in_hand || typed.eye_to_hand, "--samples");
  refuse(typed.planar || !typed.plane_a.empty() || !typed.plane_b.empty(), "--planar");
  refuse(!typed.scale.empty() || !typed.scale_a.empty() || !typed.scale_b.empty(), "--scale");
  refuse(!typed.truth.empty(), "--truth");
  refuse(!typed.nominal.empty(), "--nominal");
  refuse(!typed.goal.empty(), "--goal");
  refuse(!typed.reading.a.times_file.empty() || !typed.reading.b.times_file.empty(), "--times-a, --times-b");
  refuse(!typed.reading.a.columns.empty() || !typed.reading.b.columns.empty(), "--columns-a, --columns-b");
  refuse(typed.invert_a || typed.invert_b, "--invert-a, --invert-b");
  refuse(!typed.order_a.empty() || !typed.order_b.empty(), "--quaternion-order-a, --quaternion-order-b");
  refuse(!typed.time_offset.empty() && typed.time_offset != "auto", "--time-offset with a number");
  refuse(!method_from_name(typed.method), "--method with a baseline");
}

/// What all pairs have in common.
SolveRequest common_request(const RequestOptions& typed) {
  RequestOptions pairwise = typed;
  pairwise.source = {};
  pairwise.source.a = pairwise.source.b = "-";
  pairwise.append.clear();
  SolveRequest request = understood(pairwise);
  request.calibration.method = *method_from_name(typed.method);
  return request;
}

RigRequest rig_request(const RequestOptions& typed, const RigOptionsTyped& rig) {
  RigRequest request;
  request.append = typed.append;
  request.log = typed.source.log;
  request.reading = typed.reading.both;
  request.unanswered = print_warnings;
  if (rig.rig.empty()) {
    request.sources = {typed.source.a, typed.source.b};
    request.sources.insert(request.sources.end(), rig.more.begin(), rig.more.end());
    request.names = names_of(request.sources, typed.source.log.empty());
  } else {
    if (!typed.source.a.empty()) throw UsageError("--rig: takes --from NAME=FILE or --log, not A and B");
    request.rig = rig.rig;
    request.from = rig.from;
  }
  return request;
}

RigReport with_progress(RigRequest request) {
  Progress progress("egocal solve");
  request.progress = [&progress](double part) { progress(part); };
  return calibrate_rig(request);
}

void write_tree(const RigReport& report, const RigOutput& output) {
  for (const std::string& name : report.names)
    if (!is_frame_name(name))
      say(fmt::format("egocal: the name '{}' is written with _ for what is no letter, digit or _ - . /",
                      name));
  for (const std::string& line : tree_remarks(report)) say("egocal: " + line);
  const std::string text = extrinsic_tree_text(
      tree_of(report), *extrinsic_format_from_name(output.format.empty() ? "yaml" : output.format));
  if (output.out.empty())
    fmt::print("{}", text);
  else
    write_whole_file(output.out, text);
}

std::string json_text(const RigReport& report, const RigRequest& request, const SolveRequest& common,
                      const RigOutput& output) {
  nlohmann::ordered_json json = rig_json(report);
  json["notes"] = report.warnings;
  append_json(json, provenance_json(output.command_line));
  json["settings"] = settings_json(common);
  for (const char* of_two : {"scale", "scale_of", "read_a", "read_b"}) json["settings"].erase(of_two);
  std::vector<std::pair<std::string, std::string>> files{{"rig", request.rig}, {"log", request.log}};
  for (std::size_t i = 0; i < report.names.size(); ++i)
    files.emplace_back(report.names[i], report.sources[i]);
  for (const std::string& file : request.append) files.emplace_back("append", file);
  json["files"] = files_json(files);
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

void add_rig_options(cli::App command, RigOptionsTyped& options) {
  command.add_option("MORE", options.more, "further sensors: all pairs, loops, one consistent set");
  command.add_option("--rig", options.rig, "the sensors of a rig file, each by --from, or all by --log");
  command.add_option("--from", options.from, "NAME=FILE: the trajectory of a sensor of the rig")
      .each_a_value();
}

bool is_rig(const RigOptionsTyped& options) {
  return !options.more.empty() || !options.rig.empty();
}

void solve_rig_command(const RequestOptions& typed, const RigOptionsTyped& rig, const RigOutput& output) {
  refuse_options_of_two(typed);
  if (!typed.source.log.empty()) refuse_reading_options(typed.reading, "--log");
  if (!output.format.empty() && !holds_tree(*extrinsic_format_from_name(output.format)))
    throw UsageError("--format " + output.format + ": holds one extrinsic; a rig can be written as " +
                     tree_format_names());
  const SolveRequest common = common_request(typed);
  RigRequest request = rig_request(typed, rig);
  request.calibration = common.calibration;
  const RigReport report = with_progress(request);
  print_warnings(report.warnings);
  const bool written = !output.format.empty() || !output.out.empty();
  if (written) write_tree(report, output);
  if (!written || !output.out.empty())
    fmt::print("{}\n", output.json ? json_text(report, request, common, output) : rig_text(report));
  // a tree without a sensor that was asked for must not look like the rig's
  if (report.contradictory || report.short_of_goal || !report.apart.empty()) throw cli::Exit{3};
}

}  // namespace egocal::tools
