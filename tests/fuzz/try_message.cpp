// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "try_message.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/decode.hpp"
#include "egocal/bus/scale.hpp"
#include "egocal/bus/verdict.hpp"
#include "require.hpp"

namespace {

using namespace egocal;
using fuzz::require;

bool finite(const DualQuaternion& q) {
  return q.vec().allFinite();
}

void enter(const StampedPose& pose) {
  require(finite(pose.pose), "a decoded pose is finite");
  require(std::abs(pose.pose.real.norm() - 1) < 1e-9, "its quaternion is of unit length");
  require(bus::plausible_time(pose.time_us), "its time is one");
}
void enter(const odometry_t& message) {
  if (const auto pose = bus::to_stamped_pose(message)) enter(*pose.value);
}
void enter(const bot_core::pose_t& message) {
  if (const auto pose = bus::to_stamped_pose(message)) enter(*pose.value);
}
void enter(const problem_t& message) {
  const auto problem = bus::to_problem(message);
  if (!problem) {
    fuzz::require_one_line(problem.reason);
    return;
  }
  const Problem& p = *problem.value;
  require(p.blocks.size() == message.blocks.size(), "no block is lost by decoding");
  for (const Statistics& block : p.blocks) {
    require(block.dual_rows.allFinite(), "decoded statistics are finite");
    require(block.dual_rows == block.dual_rows.transpose(), "and symmetric");
    // blocks that touch each other end with one that takes off what is in two of them
    const bool takes_off = p.blocks.size() > 1 && &block == &p.blocks.back();
    require(std::isfinite(block.weight) && (block.weight > 0 || takes_off), "and have a weight");
  }
  require(p.blocks.empty() || sum_blocks(p.blocks).weight > 0,
          "the whole of a problem has a positive weight");
  require(!p.prior || finite(*p.prior), "a decoded prior is finite");
  // names and counts are the sender's; all the rest must go out as it came in
  problem_t out = bus::to_message(p);
  out.sensor_a = message.sensor_a;
  out.sensor_b = message.sensor_b;
  const auto again = bus::to_problem(out);
  require(again && again.value->blocks.size() == p.blocks.size(), "a problem that came in can go out");
  for (std::size_t i = 0; i < p.blocks.size(); ++i)
    require(again.value->blocks[i].dual_rows == p.blocks[i].dual_rows, "with the same statistics");
}
void enter(const calibration_t& message) {
  const auto answer = bus::to_answer(message);
  if (!answer) {
    fuzz::require_one_line(answer.reason);
    return;
  }
  require(finite(answer.value->T_a_b), "a decoded answer is finite");
  require(std::isfinite(answer.value->certificate.cost), "and so is its cost");
  require(answer.value->certificate.gap >= 0, "and its gap is one");
  fuzz::require(bus::printable(message.solver) == message.solver, "decoded names can be printed");
}
void enter(const status_t& message) {
  const std::string text = bus::printable(message.name + message.last_error);
  require(text.size() <= 200, "a line for people is cut to length");
  if (bus::plausible_name(message.name))
    require(bus::printable(message.name) == message.name, "a plausible name can be printed");
}
void enter(const command_t& message) {
  if (bus::plausible_name(message.to))
    require(bus::printable(message.to) == message.to, "a plausible name can be printed");
}
void enter(const verdict_t& message) {
  const auto verdict = bus::to_verdict(message);
  if (!verdict) {
    fuzz::require_one_line(verdict.reason);
    return;
  }
  const Diagnosis& diagnosis = verdict.value->diagnosis;
  require(finite(verdict.value->judged.T_a_b), "the answer of a verdict is finite");
  for (const std::string& text : {diagnosis.reason, message.goal_missing, message.next})
    require(bus::printable(text, text.size()) == text, "texts of a verdict can be printed");
  for (const Finding& finding : diagnosis.findings) {
    require(bus::printable(finding.message + finding.remedy + finding.code, 5000) ==
                finding.message + finding.remedy + finding.code,
            "texts of a finding can be printed");
    require(!finding.T_a_b || finite(to_dual_quaternion(*finding.T_a_b)), "answers of findings are finite");
  }
  require(!diagnosis.goal || diagnosis.goal->missing.size() <= 6, "there are six directions");
  const auto again = bus::to_message(diagnosis, verdict.value->judged);
  require(again.findings.size() == message.findings.size(), "a verdict that came in can go out");
}
void enter(const scale_problem_t& message) {
  const auto problem = bus::to_scale_problem(message);
  if (!problem) {
    fuzz::require_one_line(problem.reason);
    return;
  }
  const ScaleSolution solution = solve_scale(problem.value->blocks, problem.value->options);
  require(std::isfinite(solution.scale), "a scale is finite");
  require(bus::to_message(*problem.value).blocks.size() == message.blocks.size(), "it can go out again");
}
void enter(const scale_t& message) {
  const auto scale = bus::to_scale(message);
  if (!scale) {
    fuzz::require_one_line(scale.reason);
    return;
  }
  require(std::isfinite(scale.value->scale) && scale.value->scale > 0, "a scale is positive");
}
void enter(const motion_pair_t&) {}

}  // namespace

namespace egocal::fuzz {

template <class Message>
void try_message(std::span<const std::uint8_t> data) {
  // a copy without room to spare: a read beyond the end is seen
  const std::vector<std::byte> bytes(reinterpret_cast<const std::byte*>(data.data()),
                                     reinterpret_cast<const std::byte*>(data.data()) + data.size());
  Message message{};
  const bool decoded = bus::decode(bytes, message);
  require(decoded == bus::is_a<Message>(bytes), "decode and is_a agree");
  if (!decoded) return;
  require(bus::encode(message).size() == bytes.size(), "a message is as long as its bytes");
  enter(message);
}

template void try_message<odometry_t>(std::span<const std::uint8_t>);
template void try_message<bot_core::pose_t>(std::span<const std::uint8_t>);
template void try_message<motion_pair_t>(std::span<const std::uint8_t>);
template void try_message<problem_t>(std::span<const std::uint8_t>);
template void try_message<calibration_t>(std::span<const std::uint8_t>);
template void try_message<status_t>(std::span<const std::uint8_t>);
template void try_message<command_t>(std::span<const std::uint8_t>);
template void try_message<verdict_t>(std::span<const std::uint8_t>);
template void try_message<scale_problem_t>(std::span<const std::uint8_t>);
template void try_message<scale_t>(std::span<const std::uint8_t>);

}  // namespace egocal::fuzz
