// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "commands/commands.hpp"
#include "commands/reading_options.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/error.hpp"
#include "egocal/evaluation/alignment.hpp"
#include "offline/provenance.hpp"
#include "offline/trajectory_source.hpp"

namespace egocal::tools {

namespace {

struct Options {
  std::string a, b, out;
  ReadingOptions reading;
  bool time_offset = false, json = false;
};

TrajectoryReading read(const std::string& name, const ReadOptions& options) {
  TrajectoryReading result = read_any_trajectory(name, options);
  for (const std::string& note : result.notes) fmt::print(stderr, "egocal: {}: {}\n", name, note);
  return result;
}

nlohmann::ordered_json pose_json(const Pose& T) {
  return {{"translation", {T.translation.x(), T.translation.y(), T.translation.z()}},
          {"rotation_wxyz", {T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z()}}};
}

std::string pose_text(const Pose& T) {
  return fmt::format("{:.6f} {:.6f} {:.6f} m, quaternion w x y z {:.9f} {:.9f} {:.9f} {:.9f}",
                     T.translation.x(), T.translation.y(), T.translation.z(), T.rotation.w(), T.rotation.x(),
                     T.rotation.y(), T.rotation.z());
}

void run(const Options& options, const std::string& command_line) {
  const Trajectory a = read(options.a, options.reading.of_a()).trajectory;
  const Trajectory b = read(options.b, options.reading.of_b()).trajectory;
  CalibrationOptions calibration_options;
  calibration_options.estimate_time_offset = options.time_offset;
  const Calibration calibration = calibrate(a, b, calibration_options);
  const Alignment alignment = align(a, b, calibration.T_a_b, calibration.time_offset_applied);
  const bool certified = calibration.certificate.optimality == Optimality::certified;
  if (!options.out.empty()) write_tum(options.out, alignment.b_as_a);
  constexpr double degrees = 180 / std::numbers::pi;
  if (options.json) {
    nlohmann::ordered_json object{{"T_a_b", pose_json(calibration.T_a_b)},
                                  {"T_world_a_world_b", pose_json(alignment.T_world_a_world_b)},
                                  {"certified", certified},
                                  {"poses", alignment.b_as_a.size()},
                                  {"compared", alignment.compared},
                                  {"rms_translation_m", alignment.rms_translation},
                                  {"rms_rotation_rad", alignment.rms_rotation},
                                  {"time_offset_s", calibration.time_offset_applied}};
    append_json(object, provenance_json(command_line));
    object["files"] = files_json({{"a", options.a},
                                  {"b", options.b},
                                  {"times_a", options.reading.of_a().times_file},
                                  {"times_b", options.reading.of_b().times_file}});
    fmt::print("{}\n", object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return;
  }
  fmt::print("extrinsic    T_a_b, pose of sensor b in sensor a: {}{}\n", pose_text(calibration.T_a_b),
             certified ? " (certified)" : " (NOT certified)");
  fmt::print("world frames T_wa_wb, pose of b's world in a's world: {}\n",
             pose_text(alignment.T_world_a_world_b));
  fmt::print("agreement    {} poses compared, RMS {:.4f} m, {:.4f} deg\n", alignment.compared,
             alignment.rms_translation, alignment.rms_rotation * degrees);
  if (!options.out.empty())
    fmt::print("written      {}: b as a trajectory of sensor a in the world of a, {} poses (TUM)\n",
               options.out, alignment.b_as_a.size());
}

}  // namespace

void add_align(cli::App program) {
  const auto options = std::make_shared<Options>();
  cli::App command = program.add_subcommand(
      "align", "lays trajectory B over A: extrinsic, transform between the worlds, B in A's frames");
  command.add_option("A", options->a, "FILE or FILE:TOPIC of sensor a").required();
  command.add_option("B", options->b, "FILE or FILE:TOPIC of sensor b").required();
  add_reading_options(command, options->reading);
  command.add_flag("--time-offset", options->time_offset, "estimates the offset of the clocks first");
  command.add_option("--out", options->out, "B as a trajectory of sensor a in the world of a, as TUM");
  command.add_flag("--json", options->json, "one JSON object on standard output");
  command.callback([options, command] { run(*options, command.command_line()); });
}

}  // namespace egocal::tools
