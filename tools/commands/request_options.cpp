// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/request_options.hpp"

#include <fmt/format.h>

#include <tuple>

#include "arguments.hpp"
#include "egocal/online/nominal_part.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

Reading reading(bool invert, const std::string& order) {
  Reading result;
  result.invert = invert;
  if (order == "wxyz") result.quaternion_order = QuaternionOrder::wxyz;
  if (order == "xyzw") result.quaternion_order = QuaternionOrder::xyzw;
  return result;
}

void read_scale(const char* option, const std::string& text, Side side, SolveRequest& request) {
  if (text.empty()) return;
  if (!request.scale_option.empty())
    throw UsageError(std::string(option) +
                     ": one sensor's translations only; the other one's unit is that of the answer");
  request.scale_option = option;
  CalibrationOptions& calibration = request.calibration;
  calibration.scale_side = side;
  calibration.estimate_scale = text == "auto";
  if (calibration.estimate_scale) return;
  constexpr Range factors{1e-9, 1e9};  // limits: nanometres and millions of kilometres
  calibration.scale = number_in(option, text, factors);
}

/// Sets of still poses know no time, no stride and no ground.
void read_samples(const RequestOptions& options, SolveRequest& request) {
  if (!options.samples) {
    if (options.eye_in_hand || options.eye_to_hand)
      throw UsageError("--eye-in-hand, --eye-to-hand: go with --samples");
    return;
  }
  if (options.eye_in_hand && options.eye_to_hand)
    throw UsageError("--eye-in-hand: the camera is either on the hand or beside the arm");
  const auto refuse = [](bool given, const char* option) {
    if (given) throw UsageError(std::string(option) + ": does not go with --samples");
  };
  refuse(!options.source.pairs.empty(), "--pairs");
  refuse(options.planar, "--planar");
  refuse(!options.stride.empty(), "--stride");
  refuse(!options.time_offset.empty(), "--time-offset");
  refuse(!options.append.empty(), "--append");
  refuse(options.weights != "auto", "--weights");
  refuse(options.max_gap != RequestOptions().max_gap, "--max-gap");
  refuse(options.scale == "auto" || options.scale_a == "auto" || options.scale_b == "auto", "--scale auto");
  refuse(options.method != "global" && options.method != "dual", "--method");
  request.samples.emplace();
  request.samples->eye_to_hand = options.eye_to_hand;
}

/// Motion pairs have no times, no poses and no steps.
void refuse_options_of_streams(const RequestOptions& options) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw UsageError(std::string(option) + ": does not go with --pairs");
  };
  refuse_reading_options(options.reading, "--pairs");
  refuse(!options.stride.empty(), "--stride");
  refuse(!options.time_offset.empty(), "--time-offset");
  refuse(options.max_gap != RequestOptions().max_gap, "--max-gap");
}

/// The baselines of the paper leave no direction to a nominal value, and are not judged; a part of one is
/// completed by an answer of streams.
void refuse_unused_nominal(const RequestOptions& options, bool part) {
  const auto refuse = [](const std::string& option) {
    throw UsageError("--nominal: does not go with " + option + ", which takes nothing from it");
  };
  if (!method_from_name(options.method)) refuse("--method " + options.method);
  if (options.samples && part) throw UsageError("--nominal: with --samples all of it is needed, without nan");
}

/// Further drives, and sets of still poses.
void add_options_of_other_sources(cli::App command, RequestOptions& options) {
  command.add_option("--append", options.append,
                     "another drive of the same sensors: a file for A and one for B; may be repeated");
  command.add_flag(
      "--samples", options.samples,
      "still poses in any order, as of a robot arm, instead of streams: never interpolated; rows "
      "belong together by nearest stamp, or by order");
  command.add_flag("--eye-in-hand", options.eye_in_hand,
                   "with --samples: A is the hand in the base, B the camera in the target's frame [default]");
  command.add_flag("--eye-to-hand", options.eye_to_hand,
                   "with --samples: the camera stands beside the arm; the answer is the camera in the base");
}

/// Which files are read, and how.
void read_source(const RequestOptions& options, SolveRequest& request) {
  request.source = options.source;
  request.source.reading_a = options.reading.of_a();
  request.source.reading_b = options.reading.of_b();
  request.append = options.append;
  const bool trajectories = options.source.pairs.empty();
  if (trajectories && (options.source.a.empty() || options.source.b.empty()))
    throw UsageError(!options.source.log.empty() ? "expected two channel names A and B of the log"
                     : options.sources == Sources::all
                         ? "expected two trajectory files A and B, or --pairs FILE"
                         : "expected two trajectory files A and B");
  if (!trajectories && (!options.source.a.empty() || !options.source.log.empty()))
    throw UsageError("--pairs: takes the place of A and B and of --log");
  if (!trajectories) refuse_options_of_streams(options);
  if (!options.source.log.empty()) refuse_reading_options(options.reading, "--log");
}

void read_planes(const RequestOptions& options, PairingOptions& pairing) {
  if (options.planar != (!options.plane_a.empty() || !options.plane_b.empty()) ||
      options.plane_a.empty() != options.plane_b.empty())
    throw UsageError(options.planar            ? "--planar: goes with both --plane-a and --plane-b"
                     : options.plane_a.empty() ? "--plane-b: goes with --planar and --plane-a"
                                               : "--plane-a: goes with --planar and --plane-b");
  if (!options.planar) return;
  pairing.mode = Mode::planar;
  pairing.plane_a = plane("--plane-a", options.plane_a);
  pairing.plane_b = plane("--plane-b", options.plane_b);
}

void read_weights_and_stride(const RequestOptions& options, PairingOptions& pairing) {
  // equal weights are the paper's plain method: every motion of one step, no outliers
  if (options.weights == "equal") {
    pairing.balance = Balance{};
    pairing.robust = false;
    if (options.stride.empty()) pairing.stride = 1;
  } else if (options.weights != "auto") {
    pairing.balance = balance("--weights", options.weights);
  }
  if (options.stride.empty() || options.stride == "auto") return;
  const double stride = number_in("--stride", options.stride, limits::stride);
  if (stride != static_cast<int>(stride))
    throw UsageError("--stride: expected auto or a whole number, got '" + options.stride + "'");
  pairing.stride = static_cast<int>(stride);
}

void read_nominal(const RequestOptions& options, SolveRequest& request) {
  if (options.nominal.empty()) return;
  const Pose given = nominal("--nominal", options.nominal);
  if (is_part(given))
    request.nominal_part = given;
  else
    request.calibration.pairing.prior = to_dual_quaternion(given);
  refuse_unused_nominal(options, is_part(given));
}

}  // namespace

SolveRequest understood(const RequestOptions& options) {
  SolveRequest result;
  result.unanswered = print_warnings;
  read_source(options, result);
  result.method = options.method;
  CalibrationOptions& calibration = result.calibration;
  read_planes(options, calibration.pairing);
  read_weights_and_stride(options, calibration.pairing);
  if (options.time_offset == "auto")
    calibration.estimate_time_offset = true;
  else if (!options.time_offset.empty())
    calibration.pairing.time_offset = number_in("--time-offset", options.time_offset, limits::time_offset);
  calibration.pairing.max_gap = options.max_gap;
  calibration.read_a = reading(options.invert_a, options.order_a);
  calibration.read_b = reading(options.invert_b, options.order_b);
  if (!options.source.pairs.empty() &&
      (options.invert_a || options.invert_b || !options.order_a.empty() || !options.order_b.empty()))
    throw UsageError("--invert, --quaternion-order: apply to poses, not to motion pairs");
  if (!options.goal.empty()) calibration.diagnosis.goal = goal("--goal", options.goal);
  read_scale("--scale", options.scale, Side::a, result);
  read_scale("--scale-a", options.scale_a, Side::a, result);
  read_scale("--scale-b", options.scale_b, Side::b, result);
  if (!options.truth.empty()) result.truth = pose("--truth", options.truth);
  read_nominal(options, result);
  read_samples(options, result);
  return result;
}

void add_request_options(cli::App command, RequestOptions& options, Sources sources) {
  options.sources = sources;
  command.add_option(
      "A", options.source.a,
      "trajectory of sensor a: FILE or FILE:TOPIC of a ROS bag, MCAP, LCM log, TUM, KITTI, EuRoC or "
      "other csv; with --log its channel");
  command.add_option("B", options.source.b, "trajectory of sensor b");
  command.add_option("--log", options.source.log, "LCM log; A and B are names of its channels");
  if (sources == Sources::all)
    command.add_option("--pairs", options.source.pairs,
                       "motion pairs instead, one a line: 16 numbers, dual quaternions of a and b");
  add_reading_options(command, options.reading);
  command.add_option("--method", options.method, "solver, or a baseline of the paper")
      .check(cli::Check::one_of(
          {"global", "fast", "dual", "sdp", "sqp", "slsqp", "analytic", "matrix", "local"}))
      .show_default();
  command.add_flag("--planar", options.planar, "x, y and yaw only; the rest from the ground planes");
  command.add_option("--plane-a", options.plane_a,
                     "NX,NY,NZ,D: ground seen from a, n . x = D, unit normal n up [m]");
  command.add_option("--plane-b", options.plane_b, "ground seen from b");
  command.add_option(
      "--stride", options.stride,
      "steps of the slower stream in one motion: a number or auto [auto; 1 with --weights equal]");
  command.add_option("--weights", options.weights, "of rotation and translation: auto, equal or R:T")
      .show_default();
  command.add_option("--time-offset", options.time_offset, "added to the times of B: seconds or auto [0]");
  command.add_option("--max-gap", options.max_gap, "poses further apart are not interpolated between [s]")
      .check(cli::Check::range(limits::max_gap.least, limits::max_gap.most))
      .show_default();
  for (const auto& [stream, invert, order] : {std::tuple{"a", &options.invert_a, &options.order_a},
                                              std::tuple{"b", &options.invert_b, &options.order_b}}) {
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
  command.add_option("--goal", options.goal,
                     "ROTATION,TRANSLATION as 0.1deg,2cm: standard deviations that are enough; exit code 3 "
                     "where they are not reached");
  command.add_option("--scale", options.scale,
                     "the translations of A are multiplied by it: auto (A is a camera without scale) or a "
                     "factor; the extrinsic is in the unit of B");
  command.add_option("--scale-a", options.scale_a, "the same as --scale, and says that A is meant");
  command.add_option("--scale-b", options.scale_b, "the same for B; the extrinsic is in the unit of A");
  if (sources == Sources::all) add_options_of_other_sources(command, options);
  command.add_option(
      "--nominal", options.nominal,
      "X,Y,Z,QW,QX,QY,QZ or X,Y,Z, nan for what is not known: taken where the motions show nothing");
  command.add_option("--truth", options.truth, "X,Y,Z,QW,QX,QY,QZ: known extrinsic, to show the error (32)");
}

}  // namespace egocal::tools
