// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands/commands.hpp"
#include "commands/request_options.hpp"
#include "egocal/bus/pose_json.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/degrees.hpp"
#include "egocal/evaluation/alignment.hpp"
#include "egocal/in_words.hpp"
#include "egocal/pairing/time_offset.hpp"
#include "offline/pair/unit.hpp"
#include "offline/printing/provenance.hpp"
#include "offline/printing/report.hpp"
#include "offline/printing/trust.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

struct AlignOptions {
  RequestOptions request;
  std::string out;
  bool json = false;
};

/// unit: of lengths, "m" or "unit of b".
std::string pose_text(const Pose& T, const std::string& unit) {
  return fmt::format("{:.6f} {:.6f} {:.6f} [{}], quaternion w x y z {:.9f} {:.9f} {:.9f} {:.9f}",
                     T.translation.x(), T.translation.y(), T.translation.z(), unit, T.rotation.w(),
                     T.rotation.x(), T.rotation.y(), T.rotation.z());
}

nlohmann::ordered_json as_json(const SolveRequest& request, const SolveResult& result,
                               const Alignment& alignment, const std::string& command_line) {
  const Calibration& calibration = result.calibration;
  nlohmann::ordered_json json = trust_json(calibration);
  json["T_a_b"] = bus::pose_json(calibration.T_a_b);
  json["T_world_a_world_b"] = bus::pose_json(alignment.T_world_a_world_b);
  json["certified"] = calibration.certificate.optimality == Optimality::certified;
  json["poses"] = alignment.b_as_a.size();
  json["compared"] = alignment.compared;
  json["rms_translation_m"] = alignment.rms_translation;
  json["rms_rotation_rad"] = alignment.rms_rotation;
  json["time_offset_s"] = calibration.time_offset_applied;
  json["scale_applied"] = calibration.scale_applied;
  json["metres"] = in_metres(result);
  append_json(json, provenance_json(command_line));
  json["settings"] = settings_json(request);
  json["files"] = files_json(request);
  return json;
}

std::string as_text(const SolveResult& result, const Alignment& alignment) {
  const Calibration& calibration = result.calibration;
  const std::string unit = unit_of_lengths(result);
  const bool certified = calibration.certificate.optimality == Optimality::certified;
  std::string text = trust_text(calibration) + unit_text(result);
  text += fmt::format("extrinsic     T_a_b, pose of sensor b in sensor a: {}{}\n",
                      pose_text(calibration.T_a_b, unit),
                      certified ? ", optimal (proven)" : ", NOT proven to be optimal");
  text += fmt::format("world frames  T_wa_wb, pose of b's world in a's world: {}\n",
                      pose_text(alignment.T_world_a_world_b, unit));
  if (calibration.scale_applied != 1)
    text += fmt::format("scale         {:.6g} times the lengths of {}\n", calibration.scale_applied,
                        result.scale_side == Side::a ? "a" : "b");
  text += clocks_text(calibration);
  text += fmt::format("agreement     {} compared, RMS {:.4f} {}, {:.4f} deg\n",
                      counted(alignment.compared, "pose"), alignment.rms_translation, "[" + unit + "]",
                      alignment.rms_rotation * degrees_per_radian);
  return text;
}

void run_align(const AlignOptions& options, const std::string& command_line) {
  SolveRequest request = understood(options.request);
  request.keep_motions = true;
  const SolveResult result = calibrate_offline(request);
  print_warnings(result.warnings);
  const Calibration& calibration = result.calibration;
  const std::optional<TimeOffset>& offset = calibration.time_offset;
  const Alignment alignment =
      offset ? align(result.trajectory_a, on_clock_of_a(*offset, result.trajectory_b), calibration.T_a_b, 0)
             : align(result.trajectory_a, result.trajectory_b, calibration.T_a_b,
                     calibration.time_offset_applied);
  if (!options.out.empty()) write_tum(options.out, alignment.b_as_a);
  if (options.json) {
    fmt::print("{}\n", as_json(request, result, alignment, command_line)
                           .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else {
    fmt::print("{}", as_text(result, alignment));
    if (!options.out.empty())
      fmt::print("written       {}: b as a trajectory of sensor a in the world of a, {} (TUM)\n", options.out,
                 counted(alignment.b_as_a.size(), "pose"));
  }
  if (calibration.verdict == Verdict::contradictory || (calibration.goal && !calibration.goal->reached))
    throw cli::Exit{3};
}

}  // namespace

void add_align(cli::App program) {
  const auto options = std::make_shared<AlignOptions>();
  cli::App command = program.add_subcommand(
      "align", "lays trajectory B over A: extrinsic, transform between the worlds, B in A's frames");
  add_request_options(command, options->request, Sources::two_trajectories);
  command.add_output("--out", options->out, "B as a trajectory of sensor a in the world of a, as TUM");
  command.add_flag("--json", options->json, "one JSON object on standard output");
  command.callback([options, command] { run_align(*options, command.command_line()); });
}

}  // namespace egocal::tools
