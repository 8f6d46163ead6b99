// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "commands/commands.hpp"
#include "commands/reading_options.hpp"
#include "offline/pair/calibration.hpp"
#include "offline/printing/provenance.hpp"
#include "offline/printing/trust.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

struct CheckOptions {
  MotionSource source;
  ReadingOptions reading;
  bool json = false;
};

/// "-": a tenth without motions has no residual, one at rest none as a part of the distance.
std::string with_decimals(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string tenths_text(const Fit& fit) {
  std::string text = "\n    from      to   rotation  translation  of the distance\n";
  for (const FitTenth& tenth : fit.tenths)
    text += fmt::format("{:7.1f} {:7.1f} s {:>8} deg {:>8} cm {:>12} %\n", tenth.begin, tenth.end,
                        with_decimals(tenth.rotation_median * 57.29577951308232, 3),
                        with_decimals(100 * tenth.translation_median, 2),
                        with_decimals(100 * tenth.translation_relative, 2));
  return text;
}

void run_check(const CheckOptions& options, const std::string& command_line) {
  if (!options.source.log.empty()) refuse_reading_options(options.reading, "--log");
  SolveRequest request;
  request.unanswered = print_warnings;
  request.source = options.source;
  request.source.reading_a = options.reading.of_a();
  request.source.reading_b = options.reading.of_b();
  // check has none of its options but those for reading
  request.solve = options.source.log.empty() ? "egocal solve A B " : "egocal solve A B --log LOG ";
  const SolveResult result = calibrate_offline(request);
  print_warnings(result.warnings);
  const Calibration& calibration = result.calibration;
  if (options.json) {
    nlohmann::ordered_json json = trust_json(calibration);
    append_json(json, provenance_json(command_line));
    json["settings"] = settings_json(request);
    json["files"] = files_json(request);
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else {
    fmt::print("{}{}", trust_text(calibration), tenths_text(calibration.fit));
  }
  if (calibration.verdict == Verdict::contradictory) throw cli::Exit{3};
}

}  // namespace

void add_check(cli::App program) {
  const auto options = std::make_shared<CheckOptions>();
  cli::App command = program.add_subcommand(
      "check", "do two trajectories belong together? Tries other readings, scale, clock and a moved mount");
  command.add_option("A", options->source.a, "trajectory of sensor a; with --log its channel").required();
  command.add_option("B", options->source.b, "trajectory of sensor b").required();
  command.add_option("--log", options->source.log, "LCM log; A and B are names of its channels");
  add_reading_options(command, options->reading);
  command.add_flag("--json", options->json, "one JSON object on standard output");
  command.callback([options, command] { run_check(*options, command.command_line()); });
}

}  // namespace egocal::tools
