// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <limits>
#include <memory>
#include <optional>

#include "commands/commands.hpp"
#include "commands/request_options.hpp"
#include "commands/solve_rig.hpp"
#include "egocal/io/extrinsic_text.hpp"
#include "egocal/io/whole_file.hpp"
#include "offline/extrinsics/named_extrinsic.hpp"
#include "offline/pair/calibration.hpp"
#include "offline/pair/unit.hpp"
#include "offline/printing/provenance.hpp"
#include "offline/printing/report.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

/// The options as typed; empty means not given.
struct SolveOptions {
  RequestOptions request;
  RigOptionsTyped rig;
  bool json = false;
  std::string format, out, frame_a = "a", frame_b = "b";
};

/// With --eye-to-hand a is the file of the hand, and the answer is the pose of the camera in the base.
SolveOptions with_names_of_arm(SolveOptions options) {
  if (!options.request.eye_to_hand) return options;
  if (options.frame_a == SolveOptions().frame_a) options.frame_a = "base";
  if (options.frame_b == SolveOptions().frame_b) options.frame_b = "camera";
  return options;
}

/// The answer as a file for another program; what its reader must know goes to standard error as well.
void write_extrinsic(const SolveOptions& options, const SolveResult& result) {
  const Calibration& calibration = result.calibration;
  NamedExtrinsic extrinsic = named_extrinsic(options.frame_a, options.frame_b, calibration);
  if (const std::optional<ScaleSolution>& scale = calibration.scale)
    extrinsic.scale = NamedScale{result.scale_side == Side::a ? options.frame_a : options.frame_b,
                                 scale->scale,
                                 scale->observable ? scale->stddev : std::numeric_limits<double>::infinity(),
                                 scale->certified && !result.course,
                                 in_metres(result),
                                 result.course.has_value()};
  for (const std::string& line : remarks(extrinsic, calibration)) say("egocal: " + line);
  if (result.course) say("egocal: the scale changes along the drive: its mean is stated");
  if (!result.note.empty()) say("egocal: " + result.note);
  const std::string text = extrinsic_text(
      extrinsic, *extrinsic_format_from_name(options.format.empty() ? "yaml" : options.format));
  if (options.out.empty())
    fmt::print("{}", text);
  else
    write_whole_file(options.out, text);
}

/// Everything that docs/json.md lists.
std::string solution_json(const SolveOptions& options, const SolveRequest& request, const SolveResult& result,
                          const std::string& command_line) {
  nlohmann::ordered_json json = report_json(result, request.truth);
  json["frames"] = {{"parent", options.frame_a}, {"child", options.frame_b}};
  json["notes"] = result.warnings;
  append_json(json, provenance_json(command_line));
  json["settings"] = settings_json(request);
  json["files"] = files_json(request);
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void run_solve(const SolveOptions& typed, const std::string& command_line) {
  const SolveOptions options = with_names_of_arm(typed);
  if (options.json && !options.format.empty() && options.out.empty())
    throw cli::UsageError("--format: takes the place of --json on standard output; give its file by --out");
  const bool named = typed.frame_a != SolveOptions().frame_a || typed.frame_b != SolveOptions().frame_b;
  if (named && is_rig(options.rig))
    throw cli::UsageError("--frame-a, --frame-b: go with two sensors; those of a rig have names");
  if (named && !options.json && options.format.empty() && options.out.empty())
    throw cli::UsageError("--frame-a, --frame-b: go with --format, --out or --json");
  for (const auto& [option, name] :
       {std::pair{"--frame-a", &options.frame_a}, std::pair{"--frame-b", &options.frame_b}})
    if (!is_frame_name(*name))
      throw cli::UsageError(std::string(option) +
                            ": expected up to 100 letters, digits and _ - . /, no - first, got '" + *name +
                            "'");
  if (options.frame_a == options.frame_b)
    throw cli::UsageError("--frame-a, --frame-b: expected two names, got '" + options.frame_a + "' for both");
  if (is_rig(options.rig))
    return solve_rig_command(options.request, options.rig,
                             {options.json, options.format, options.out, command_line});
  if (!options.rig.from.empty()) throw cli::UsageError("--from: goes with --rig");
  const SolveRequest request = understood(options.request);
  const SolveResult result = calibrate_offline(request);
  print_warnings(result.warnings);
  const Calibration& calibration = result.calibration;
  const bool written = !options.format.empty() || !options.out.empty();
  if (written) write_extrinsic(options, result);
  if (!written || !options.out.empty())
    fmt::print("{}\n", options.json ? solution_json(options, request, result, command_line)
                                    : report_text(result, request.truth));
  if (calibration.verdict == Verdict::contradictory || (calibration.goal && !calibration.goal->reached))
    throw cli::Exit{3};
}

}  // namespace

void add_solve(cli::App program) {
  const auto options = std::make_shared<SolveOptions>();
  cli::App command = program.add_subcommand(
      "solve", "two trajectories in, the extrinsic of b in a out, with proof; or a whole rig");
  add_request_options(command, options->request);
  add_rig_options(command, options->rig);
  command.add_option("--format", options->format, "writes the extrinsic for another program [yaml]")
      .check(cli::Check::one_of(extrinsic_format_names()));
  command.add_output("--out", options->out,
                     "file for --format; without it, on standard output and nothing else");
  command.add_option("--frame-a", options->frame_a, "name of sensor a's frame in it").show_default();
  command.add_option("--frame-b", options->frame_b, "name of sensor b's frame in it").show_default();
  command.add_flag("--json", options->json, "one JSON object on standard output");
  command.callback([options, command] { run_solve(*options, command.command_line()); });
}

}  // namespace egocal::tools
