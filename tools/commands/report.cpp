// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/report.hpp"

#include <fmt/format.h>

#include <memory>

#include "commands/commands.hpp"
#include "commands/request_options.hpp"
#include "egocal/io/whole_file.hpp"
#include "offline/pair/unit.hpp"
#include "offline/printing/report.hpp"
#include "offline/printing/samples.hpp"
#include "offline/printing/scale.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

struct ReportOptions {
  RequestOptions request;
  std::string out;
};

std::string headline(const Calibration& calibration) {
  return std::string(to_string(calibration.verdict)) + ": " + calibration.reason;
}

ReportInput report_input(const SolveRequest& request, SolveResult result, const std::string& command) {
  ReportInput input;
  input.command = command;
  input.name_a = request.source.log.empty() ? request.source.a : request.source.log + ":" + request.source.a;
  input.name_b = request.source.log.empty() ? request.source.b : request.source.log + ":" + request.source.b;
  if (!request.source.pairs.empty()) input.name_a = input.name_b = request.source.pairs;
  input.a = std::move(result.trajectory_a);
  input.b = std::move(result.trajectory_b);
  input.pairs = std::move(result.fit_pairs);
  input.unit = unit_of_lengths(result);
  input.eye_to_hand = result.eye_to_hand;
  input.scale_course = scale_course_text(result);
  input.clocks = clocks_text(result.clocks);
  input.options = request.calibration;
  input.options.pairing.time_offset = result.calibration.time_offset_applied;
  // the streams of the result are as they were solved
  input.options.read_a = input.options.read_b = {};
  input.options.estimate_scale = false;
  input.options.scale = 1;
  input.method = result.method;
  input.verdict = headline(result.calibration);
  if (result.samples)
    input.samples = SamplesOfPage{samples_text(result), result.samples->residuals, result.matched.rows_a};
  input.warnings = result.warnings;
  input.calibration = std::move(result.calibration);
  input.truth = request.truth;
  return input;
}

void run_report(const ReportOptions& options, const std::string& command) {
  const ReportInput input = write_report(understood(options.request), options.out, command);
  print_warnings(input.warnings);
  fmt::print("{}\n{}\n", input.verdict, options.out);
  if (input.calibration.verdict == Verdict::contradictory ||
      (input.calibration.goal && !input.calibration.goal->reached))
    throw cli::Exit{3};
}

}  // namespace

ReportInput write_report(SolveRequest request, const std::string& out, const std::string& command) {
  request.keep_motions = true;
  ReportInput input = report_input(request, calibrate_offline(request), command);
  write_whole_file(out, report_html(input));
  return input;
}

void add_report(cli::App program) {
  const auto options = std::make_shared<ReportOptions>();
  cli::App command = program.add_subcommand(
      "report", "the answer of solve as one HTML page with pictures: print it, or hand it on");
  add_request_options(command, options->request);
  command.add_output("--out", options->out, "the page, written whole or not at all").required();
  command.callback([options, command] { run_report(*options, command.command_line()); });
}

}  // namespace egocal::tools
