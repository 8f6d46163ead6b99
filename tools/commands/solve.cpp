// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <tuple>

#include "arguments.hpp"
#include "commands/commands.hpp"
#include "egocal/io/extrinsic_text.hpp"
#include "egocal/io/whole_file.hpp"
#include "offline/calibration.hpp"
#include "offline/report.hpp"

namespace egocal::tools {

namespace {

/// As typed; empty means not given.
struct Options {
  MotionSource source;
  std::string times;
  std::string method = "global";
  bool planar = false;
  std::string plane_a, plane_b, stride, weights = "auto", time_offset, truth, nominal;
  double max_gap = 0.5;
  std::string order_a, order_b, goal;
  bool invert_a = false, invert_b = false;
  bool json = false;
  std::string format, out, frame_a = "a", frame_b = "b";
};

Reading reading(bool invert, const std::string& order) {
  Reading result;
  result.invert = invert;
  if (order == "wxyz") result.quaternion_order = QuaternionOrder::wxyz;
  if (order == "xyzw") result.quaternion_order = QuaternionOrder::xyzw;
  return result;
}

SolveRequest understood(const Options& options) {
  SolveRequest result;
  result.source = options.source;
  if (!options.times.empty()) {
    if (result.source.times_a.empty()) result.source.times_a = options.times;
    if (result.source.times_b.empty()) result.source.times_b = options.times;
  }
  const bool trajectories = options.source.pairs.empty();
  if (trajectories && (options.source.a.empty() || options.source.b.empty()))
    throw UsageError(options.source.log.empty()
                         ? "solve: expected two trajectory files A and B, or --pairs FILE"
                         : "solve: expected two channel names A and B of the log");
  if (!trajectories && (!options.source.a.empty() || !options.source.log.empty()))
    throw UsageError("--pairs: takes the place of A and B and of --log");
  result.method = options.method;

  if (options.planar != (!options.plane_a.empty() || !options.plane_b.empty()) ||
      options.plane_a.empty() != options.plane_b.empty())
    throw UsageError("--planar: goes with both --plane-a and --plane-b");
  if (options.planar) {
    result.calibration.pairing.mode = Mode::planar;
    result.calibration.pairing.plane_a = plane("--plane-a", options.plane_a);
    result.calibration.pairing.plane_b = plane("--plane-b", options.plane_b);
  }

  // equal weights are the paper's plain method: every motion of one step, none left out
  if (options.weights == "equal") {
    result.calibration.pairing.balance = Balance{};
    result.calibration.pairing.robust = false;
    if (options.stride.empty()) result.calibration.pairing.stride = 1;
  } else if (options.weights != "auto") {
    result.calibration.pairing.balance = balance("--weights", options.weights);
  }
  if (!options.stride.empty() && options.stride != "auto") {
    const double stride = number("--stride", options.stride);
    if (stride < 1 || stride > 100000 || stride != static_cast<int>(stride))
      throw UsageError("--stride: expected auto or a whole number from 1 to 100000, got '" + options.stride +
                       "'");
    result.calibration.pairing.stride = static_cast<int>(stride);
  }
  if (options.time_offset == "auto")
    result.calibration.estimate_time_offset = true;
  else if (!options.time_offset.empty())
    result.calibration.pairing.time_offset = number("--time-offset", options.time_offset);
  if (std::abs(result.calibration.pairing.time_offset) > 1e10)
    throw UsageError("--time-offset: out of range");
  if (!(options.max_gap > 0) || options.max_gap > 1e6) throw UsageError("--max-gap: expected more than 0 s");
  result.calibration.pairing.max_gap = options.max_gap;
  result.calibration.read_a = reading(options.invert_a, options.order_a);
  result.calibration.read_b = reading(options.invert_b, options.order_b);
  if (!trajectories &&
      (options.invert_a || options.invert_b || !options.order_a.empty() || !options.order_b.empty()))
    throw UsageError("--invert, --quaternion-order: apply to poses, not to motion pairs");
  if (!options.goal.empty()) result.calibration.diagnosis.goal = goal("--goal", options.goal);
  if (!options.truth.empty()) result.truth = pose("--truth", options.truth);
  if (!options.nominal.empty())
    result.calibration.pairing.prior = to_dual_quaternion(pose("--nominal", options.nominal));
  return result;
}

/// The answer as a file for another program.
void write_extrinsic(const Options& options, const SolveResult& result) {
  const Calibration& calibration = result.calibration;
  NamedExtrinsic extrinsic;
  extrinsic.parent = options.frame_a;
  extrinsic.child = options.frame_b;
  extrinsic.T_parent_child = calibration.T_a_b;
  extrinsic.certified = calibration.certificate.optimality == Optimality::certified;
  extrinsic.pairs = static_cast<long long>(total(calibration.problem.blocks).count);
  extrinsic.stddev = calibration.observability.stddev;
  for (std::size_t i = 0; i < 6; ++i)
    if (!calibration.observability.observable[i])
      (*extrinsic.stddev)[i] = std::numeric_limits<double>::infinity();
  extrinsic.usable = calibration.verdict != Verdict::contradictory;
  const std::string text = extrinsic_text(
      extrinsic, *extrinsic_format_from_name(options.format.empty() ? "yaml" : options.format));
  if (options.out.empty())
    fmt::print("{}", text);
  else
    write_whole_file(options.out, text);
}

void run(const Options& options) {
  const SolveRequest understood_options = understood(options);
  const SolveResult result = calibrate_offline(understood_options);
  for (const std::string& warning : result.warnings) fmt::print(stderr, "egocal: warning: {}\n", warning);
  const Calibration& calibration = result.calibration;
  const bool written = !options.format.empty() || !options.out.empty();
  if (written) write_extrinsic(options, result);
  if (written && calibration.verdict == Verdict::contradictory)
    fmt::print(stderr, "egocal: the motions contradict each other: do not use this extrinsic\n");
  if (!written || !options.out.empty())
    fmt::print("{}\n", options.json ? report_json(result, understood_options.truth)
                                    : report_text(result, understood_options.truth));
  if (calibration.verdict == Verdict::contradictory || (calibration.goal && !calibration.goal->reached))
    throw cli::Exit{3};
}

}  // namespace

void add_solve(cli::App program) {
  const auto options = std::make_shared<Options>();
  cli::App command =
      program.add_subcommand("solve", "two trajectories in, the extrinsic of b in a out, with proof");
  command.add_option(
      "A", options->source.a,
      "trajectory of sensor a: FILE or FILE:TOPIC of a ROS bag, MCAP, LCM log, TUM, KITTI, EuRoC or "
      "other csv; with --log its channel");
  command.add_option("B", options->source.b, "trajectory of sensor b");
  command.add_option("--log", options->source.log, "LCM log; A and B are names of its channels");
  command.add_option("--pairs", options->source.pairs,
                     "motion pairs instead, one a line: 16 numbers, dual quaternions of a and b");
  command.add_option("--times", options->times, "times of KITTI poses, one a line [s]");
  command.add_option("--times-a", options->source.times_a, "times of A alone");
  command.add_option("--times-b", options->source.times_b, "times of B alone");
  command.add_option("--columns", options->source.reading.columns,
                     "names of a table's columns: t,x,y,z,qx,qy,qz,qw or yaw, roll, pitch, - ...");
  command.add_option("--rate", options->source.reading.rate, "of KITTI poses without times [Hz; 10]");
  command.add_option("--method", options->method, "solver, or a baseline of the paper")
      .check(cli::Check::one_of(
          {"global", "fast", "dual", "sdp", "sqp", "slsqp", "analytic", "matrix", "local"}))
      .show_default();
  command.add_flag("--planar", options->planar, "x, y and yaw only; the rest from the ground planes");
  command.add_option("--plane-a", options->plane_a,
                     "NX,NY,NZ,D: ground seen from a, n . x = D, unit normal n up [m]");
  command.add_option("--plane-b", options->plane_b, "ground seen from b");
  command.add_option(
      "--stride", options->stride,
      "steps of the slower stream in one motion: a number or auto [auto; 1 with --weights equal]");
  command.add_option("--weights", options->weights, "of rotation and translation: auto, equal or R:T")
      .show_default();
  command.add_option("--time-offset", options->time_offset, "added to the times of B: seconds or auto [0]");
  command.add_option("--max-gap", options->max_gap, "poses further apart are not interpolated between [s]")
      .show_default();
  for (const auto& [stream, invert, order] : {std::tuple{"a", &options->invert_a, &options->order_a},
                                              std::tuple{"b", &options->invert_b, &options->order_b}}) {
    command.add_flag(fmt::format("--invert-{}", stream), *invert,
                     fmt::format("the poses of {} are world-to-sensor: invert each", stream));
    command
        .add_option(
            fmt::format("--quaternion-order-{}", stream), *order,
            fmt::format("columns of the quaternions of {} where they are not those of the file format: "
                        "wxyz in TUM, xyzw in EuRoC csv",
                        stream))
        .check(cli::Check::one_of({"wxyz", "xyzw"}));
  }
  command.add_option("--goal", options->goal,
                     "ROTATION,TRANSLATION as 0.1deg,2cm: standard deviations that are enough; exit code 3 "
                     "where they are not reached");
  command.add_option("--nominal", options->nominal,
                     "X,Y,Z,QW,QX,QY,QZ: taken where the motions show nothing");
  command.add_option("--truth", options->truth, "X,Y,Z,QW,QX,QY,QZ: known extrinsic, to show the error (32)");
  command.add_option("--format", options->format, "writes the extrinsic for another program [yaml]")
      .check(cli::Check::one_of(extrinsic_format_names()));
  command.add_option("--out", options->out,
                     "file for --format; without it, on standard output and nothing else");
  command.add_option("--frame-a", options->frame_a, "name of sensor a's frame in it").show_default();
  command.add_option("--frame-b", options->frame_b, "name of sensor b's frame in it").show_default();
  command.add_flag("--json", options->json, "one JSON object on standard output");
  command.callback([options] { run(*options); });
}

}  // namespace egocal::tools
