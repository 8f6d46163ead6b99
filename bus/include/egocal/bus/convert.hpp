// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "egocal/bus/decode.hpp"
#include "egocal/bus/plausible.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::bus {

/// A value from the wire, checked for range and finiteness; or the reason why it was refused, a short
/// constant text that also names its counter.
template <class T>
struct Checked {
  std::optional<T> value;
  std::string reason;
  explicit operator bool() const { return value.has_value(); }
};

Checked<StampedPose> to_stamped_pose(const odometry_t& message);
Checked<StampedPose> to_stamped_pose(const bot_core::pose_t& message);
odometry_t to_message(const StampedPose& pose, std::int64_t seq);
bot_core::pose_t to_pose_message(const StampedPose& pose);

/// Position [m] and quaternion (w x y z) of a message. Quaternions within 1 % of unit length are normalised.
Checked<DualQuaternion> to_dual_quaternion(const double (&pos)[3], const double (&quat)[4]);
void set_pose(const DualQuaternion& T, double (&pos)[3], double (&quat)[4]);
/// Optimality, cost, bound, gap and reach of an answer.
void set_certificate(const Certificate& certificate, calibration_t& message);

/// Checks the whole message: a value means that every field may be used as it stands.
Checked<Problem> to_problem(const problem_t& message);
/// Mode, planes, balance, blocks and prior; the rest is the sender's.
problem_t to_message(const Problem& problem);

/// calibration_t.status, whatever the order of the enum is.
std::int8_t wire_status(Optimality optimality);
std::optional<Optimality> optimality_from_wire(std::int8_t status);

/// Checks the whole message, and that its certificate does not contradict itself. stddev, reaches and gaps
/// may be infinite.
Checked<Answer> to_answer(const calibration_t& message);
/// The answer to a problem; who solved it and how long it took is the sender's to fill in.
calibration_t to_message(const Answer& answer, const problem_t& problem);

motion_pair_t to_message(const MotionPair& pair);

}  // namespace egocal::bus
