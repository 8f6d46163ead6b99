// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/convert.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/problem/blocks.hpp"
#include "wire_checks.hpp"

namespace egocal::bus {

namespace {

/// A cost is a sum of squares. If the message does not say how it was rounded, it may be this far below zero
/// [m^2]: the rounding of motions of 100 km.
constexpr double negative_by_rounding = 1e-6;
constexpr std::size_t largest_block_count = 2 * BlockStatistics::max_inlier_blocks;  // limit of the wire

template <std::size_t n>
bool finite(const double (&values)[n]) {
  return std::all_of(values, values + n, [](double v) { return std::isfinite(v); });
}

Checked<StampedPose> stamped(std::int64_t utime, const double (&pos)[3], const double (&quat)[4]) {
  if (!plausible_time(utime)) return {{}, "time out of range"};
  const Checked<DualQuaternion> pose = to_dual_quaternion(pos, quat);
  if (!pose) return {{}, pose.reason};
  return {StampedPose{utime, *pose.value}, {}};
}

/// Empty: no fault. In a sum of M'M the diagonal is not negative and bounds the other entries
/// (Cauchy-Schwarz).
std::string fault(const Statistics& block) {
  if (!std::isfinite(block.weight) || block.weight <= 0)
    return "statistics with a weight that is not positive";
  const Vector8d diagonal = block.dual_rows.diagonal();
  if (!block.dual_rows.allFinite() || block.dual_rows.cwiseAbs().maxCoeff() > largest_entry)
    return "statistics that are not finite";
  if (diagonal.minCoeff() < 0) return "statistics that are not a sum of squares";
  return bounded_by_diagonal(block.dual_rows, 1e-12 * diagonal.sum())
             ? ""
             : "statistics that are not a sum of squares";
}

/// Whether the certificate contradicts itself. It must have the gap between cost and bound, and no cost may
/// be negative by more than rounding. A certified answer must keep to the limit of the gap, or be proven to
/// lie close to the optimum.
bool contradicts_itself(const calibration_t& message) {
  const double gap = std::max(0.0, message.cost - message.lower_bound);
  // a sender may have computed the bound from cost and gap, which rounds it like the cost
  const double tolerance = 1e-9 * gap + 4 * std::numeric_limits<double>::epsilon() * std::abs(message.cost);
  if (!(std::abs(message.gap - gap) <= tolerance) && !(std::isinf(gap) && std::isinf(message.gap)))
    return true;
  if (message.status != wire_status(Optimality::certified)) return false;
  const CertificateOptions limits;
  const bool near = message.reach_translation <= limits.reach_translation &&
                    message.reach_rotation <= limits.reach_rotation;
  const double rounding = message.scaled_gap > 0 ? message.gap / message.scaled_gap : 0;
  return !std::isfinite(message.gap) || !(message.scaled_gap <= 1 || near) ||
         message.cost < -rounding - negative_by_rounding;
}

GroundPlane to_plane(const double (&plane)[4]) {
  return {{plane[0], plane[1], plane[2]}, plane[3]};
}

void set_plane(const GroundPlane& plane, double (&out)[4]) {
  for (int i = 0; i < 3; ++i) out[i] = plane.normal(i);
  out[3] = plane.distance;
}

void set(const Vector8d& values, double (&out)[8]) {
  std::copy_n(values.data(), 8, out);
}

}  // namespace

Checked<DualQuaternion> to_dual_quaternion(const double (&pos)[3], const double (&quat)[4]) {
  if (!finite(pos)) return {{}, "position not finite"};
  if (!finite(quat)) return {{}, "quaternion not finite"};
  if (!std::all_of(pos, pos + 3, plausible_distance)) return {{}, "position out of range"};
  Pose pose{{quat[0], quat[1], quat[2], quat[3]}, {pos[0], pos[1], pos[2]}};
  if (!plausible_norm(pose.rotation.norm())) return {{}, "quaternion not of unit length"};
  pose.rotation.normalize();
  return {to_dual_quaternion(pose), {}};
}

void set_pose(const DualQuaternion& T, double (&pos)[3], double (&quat)[4]) {
  const Pose pose = to_pose(T);
  for (int i = 0; i < 3; ++i) pos[i] = pose.translation(i);
  quat[0] = pose.rotation.w();
  quat[1] = pose.rotation.x();
  quat[2] = pose.rotation.y();
  quat[3] = pose.rotation.z();
}

Checked<StampedPose> to_stamped_pose(const odometry_t& message) {
  if (message.seq != -1 && !plausible_count(message.seq)) return {{}, "sequence number out of range"};
  if (message.covariance_size != 0 && message.covariance_size != 36)
    return {{}, "covariance of the wrong size"};
  if (std::any_of(message.covariance.begin(), message.covariance.end(),
                  [](double v) { return !std::isfinite(v); }))
    return {{}, "covariance not finite"};
  return stamped(message.utime, message.pos, message.quat);
}

Checked<StampedPose> to_stamped_pose(const bot_core::pose_t& message) {
  return stamped(message.utime, message.pos, message.orientation);
}

odometry_t to_message(const StampedPose& pose, std::int64_t seq) {
  odometry_t message{};
  message.utime = pose.time_us;
  message.seq = seq;
  set_pose(pose.pose, message.pos, message.quat);
  return message;
}

bot_core::pose_t to_pose_message(const StampedPose& pose) {
  bot_core::pose_t message{};
  message.utime = pose.time_us;
  set_pose(pose.pose, message.pos, message.orientation);
  return message;
}

Checked<Problem> to_problem(const problem_t& message) {
  if (!plausible_time(message.utime)) return {{}, "time out of range"};
  if (!plausible_time(message.session)) return {{}, "session out of range"};
  for (const std::int64_t count : {message.seq, message.matched, message.left_out, message.rejected})
    if (!plausible_count(count)) return {{}, "count out of range"};
  if (!plausible_name(message.sensor_a) || !plausible_name(message.sensor_b)) return {{}, "sensor name"};
  if (!plausible_text(message.choice) || !plausible_text(message.host)) return {{}, "text too long"};
  if (message.mode != 0 && message.mode != 1) return {{}, "unknown mode"};
  if (!std::isfinite(message.weight_rotation + message.weight_translation) || message.weight_rotation < 0 ||
      message.weight_translation < 0 || !(message.weight_rotation + message.weight_translation > 0))
    return {{}, "balance out of range"};
  if (message.stride < 1) return {{}, "stride out of range"};
  if (!limits::time_offset.contains(message.time_offset) || std::isnan(message.time_offset_stddev))
    return {{}, "time offset out of range"};
  if (message.blocks.size() > largest_block_count) return {{}, "too many blocks"};

  Problem problem;
  problem.balance = {message.weight_rotation, message.weight_translation};
  if (message.mode == 1) {
    problem.mode = Mode::planar;
    try {
      problem.plane_a = validated(to_plane(message.plane_a));
      problem.plane_b = validated(to_plane(message.plane_b));
    } catch (const Error&) {
      return {{}, "ground plane out of range"};
    }
  }
  problem.blocks.reserve(message.blocks.size());
  for (const statistics_t& in : message.blocks) {
    if (!plausible_count(in.count)) return {{}, "count out of range"};
    Statistics block;
    block.count = static_cast<std::uint64_t>(in.count);
    block.weight = in.weight;
    std::size_t next = 0;
    for (int row = 0; row < 8; ++row)
      for (int column = row; column < 8; ++column)
        block.dual_rows(row, column) = block.dual_rows(column, row) = in.q[next++];
    // blocks may touch each other: then the last one takes off what is in two of them
    const bool takes_off = in.weight < 0 && message.blocks.size() > 1 && &in == &message.blocks.back();
    Statistics sum_of_squares = block;
    if (takes_off) {
      sum_of_squares.weight *= -1;
      sum_of_squares.dual_rows *= -1;
    }
    if (std::string reason = fault(sum_of_squares); !reason.empty()) return {{}, std::move(reason)};
    problem.blocks.push_back(block);
    if (takes_off)
      if (std::string reason = fault(sum_blocks(problem.blocks)); !reason.empty())
        return {{}, std::move(reason)};
  }
  if (message.has_prior) {
    const Checked<DualQuaternion> prior = to_dual_quaternion(message.prior_pos, message.prior_quat);
    if (!prior) return {{}, "prior: " + prior.reason};
    problem.prior = *prior.value;
  }
  if (message.has_truth)
    if (const Checked<DualQuaternion> truth = to_dual_quaternion(message.truth_pos, message.truth_quat);
        !truth)
      return {{}, "truth: " + truth.reason};
  return {std::move(problem), {}};
}

problem_t to_message(const Problem& problem) {
  problem_t message{};
  message.mode = problem.mode == Mode::planar ? 1 : 0;
  set_plane(problem.plane_a, message.plane_a);
  set_plane(problem.plane_b, message.plane_b);
  message.weight_rotation = problem.balance.rotation;
  message.weight_translation = problem.balance.translation;
  message.stride = 1;
  message.time_offset_stddev = -1;
  message.n_blocks = static_cast<std::int32_t>(problem.blocks.size());
  message.blocks.resize(problem.blocks.size());
  for (std::size_t i = 0; i < problem.blocks.size(); ++i) {
    const Statistics& block = problem.blocks[i];
    statistics_t& out = message.blocks[i];
    out.count = static_cast<std::int64_t>(block.count);
    out.weight = block.weight;
    std::size_t next = 0;
    for (int row = 0; row < 8; ++row)
      for (int column = row; column < 8; ++column) out.q[next++] = block.dual_rows(row, column);
  }
  if (problem.prior) {
    message.has_prior = 1;
    set_pose(*problem.prior, message.prior_pos, message.prior_quat);
  }
  return message;
}

std::int8_t wire_status(Optimality optimality) {
  switch (optimality) {
    case Optimality::certified:
      return 0;
    case Optimality::not_optimal:
      return 1;
    case Optimality::undecided:
      break;
  }
  return 2;
}

std::optional<Optimality> optimality_from_wire(std::int8_t status) {
  for (const Optimality optimality : {Optimality::certified, Optimality::not_optimal, Optimality::undecided})
    if (status == wire_status(optimality)) return optimality;
  return std::nullopt;
}

void set_certificate(const Certificate& certificate, calibration_t& message) {
  message.cost = certificate.cost;
  message.lower_bound = certificate.lower_bound;
  message.gap = certificate.gap;
  message.scaled_gap = certificate.scaled_gap;
  message.status = wire_status(certificate.optimality);
  message.reach_translation = certificate.reach_translation;
  message.reach_rotation = certificate.reach_rotation;
}

Checked<Answer> to_answer(const calibration_t& message) {
  if (!plausible_time(message.utime)) return {{}, "time out of range"};
  if (!plausible_time(message.session)) return {{}, "session out of range"};
  if (!plausible_count(message.seq) || !plausible_count(message.pairs)) return {{}, "count out of range"};
  if (!plausible_name(message.sensor_a) || !plausible_name(message.sensor_b)) return {{}, "sensor name"};
  if (!plausible_name(message.solver)) return {{}, "solver name"};
  if (!plausible_text(message.hint)) return {{}, "text too long"};
  const std::optional<Method> method =
      message.method == "planar" ? Method::dual : method_from_name(message.method);
  if (!method) return {{}, "unknown method"};
  const Checked<DualQuaternion> T = to_dual_quaternion(message.pos, message.quat);
  if (!T) return {{}, T.reason};
  const std::optional<Optimality> optimality = optimality_from_wire(message.status);
  if (!optimality) return {{}, "unknown status"};
  if (!std::isfinite(message.cost) || std::isnan(message.lower_bound)) return {{}, "cost not finite"};
  if (!not_negative({message.gap, message.scaled_gap, message.reach_translation, message.reach_rotation}))
    return {{}, "certificate out of range"};
  const auto& stddev = message.stddev;
  if (!not_negative({stddev[0], stddev[1], stddev[2], stddev[3], stddev[4], stddev[5]}))
    return {{}, "standard deviation out of range"};
  if (contradicts_itself(message) || directions_contradict(message.observable, message.stddev))
    return {{}, "answer that contradicts itself"};
  if (message.solve_ns < 0 || message.verify_ns < 0 || message.latency_us < -1)
    return {{}, "negative duration"};

  Answer answer;
  answer.T_a_b = *T.value;
  answer.method = *method;
  Certificate& certificate = answer.certificate;
  certificate.optimality = *optimality;
  certificate.cost = message.cost;
  certificate.lower_bound = message.lower_bound;
  certificate.gap = message.gap;
  certificate.scaled_gap = message.scaled_gap;
  certificate.rounding = message.scaled_gap > 0 ? message.gap / message.scaled_gap : 0;
  certificate.reach_translation = message.reach_translation;
  certificate.reach_rotation = message.reach_rotation;
  for (std::size_t i = 0; i < 6; ++i) {
    answer.observability.observable[i] = message.observable[i] != 0;
    answer.observability.stddev[i] = message.stddev[i];
  }
  answer.observability.hint = message.hint;
  return {std::move(answer), {}};
}

calibration_t to_message(const Answer& answer, const problem_t& problem) {
  calibration_t message{};
  message.utime = problem.utime;
  message.session = problem.session;
  message.seq = problem.seq;
  for (const statistics_t& block : problem.blocks) message.pairs += block.count;
  message.sensor_a = problem.sensor_a;
  message.sensor_b = problem.sensor_b;
  message.method =
      problem.mode == 1 && answer.method != Method::slsqp ? "planar" : std::string(to_string(answer.method));
  set_pose(answer.T_a_b, message.pos, message.quat);
  set_certificate(answer.certificate, message);
  for (std::size_t i = 0; i < 6; ++i) {
    message.observable[i] = answer.observability.observable[i];
    message.stddev[i] = answer.observability.stddev[i];
  }
  message.hint = answer.observability.hint;
  message.latency_us = -1;
  return message;
}

motion_pair_t to_message(const MotionPair& pair) {
  motion_pair_t message{};
  message.utime_begin = pair.begin_us;
  message.utime_end = pair.end_us;
  set(pair.a.vec(), message.a);
  set(pair.b.vec(), message.b);
  message.eta = pair.eta;
  return message;
}

}  // namespace egocal::bus
