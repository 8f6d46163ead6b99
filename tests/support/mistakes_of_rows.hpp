// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rows that hold values of other rows, of other senders or of other times.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "egocal/io/twist_integrator.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "mistake.hpp"
#include "mistakes_of_clocks.hpp"
#include "mistakes_of_frames.hpp"
#include "mistakes_of_units.hpp"
#include "steered_part.hpp"

namespace egocal::testing {

/// Each position from another row, `later` rows further on; the rotations stay.
inline Trajectory with_positions_of_row(const Trajectory& right, int later) {
  Trajectory result;
  const auto n = static_cast<int>(right.size());
  for (int i = std::max(0, -later); i < n - std::max(0, later); ++i) {
    const StampedPose &here = right[static_cast<std::size_t>(i)],
                      &there = right[static_cast<std::size_t>(i + later)];
    result.push_back({here.time_us, canonical_sign(to_dual_quaternion(Pose{
                                        to_pose(here.pose).rotation, to_pose(there.pose).translation}))});
  }
  return result;
}

/// Steps of the position summed up again, each turned on by a part of the turn of its row: 1 is the attitude
/// at the other end of the row.
inline Trajectory with_turned_steps(const Trajectory& right, double part) {
  Trajectory result{right.front()};
  Eigen::Vector3d position = to_pose(right.front().pose).translation;
  for (std::size_t i = 1; i < right.size(); ++i) {
    const Pose before = to_pose(right[i - 1].pose), here = to_pose(right[i].pose);
    const Rotation turn = rotation_exp(part * rotation_log(here.rotation * before.rotation.conjugate()));
    position += turn * (here.translation - before.translation);
    result.push_back({right[i].time_us, canonical_sign(to_dual_quaternion(Pose{here.rotation, position}))});
  }
  return result;
}

/// Summed up from turning rates in degrees a second that were taken as radians.
inline Trajectory with_rates_in_degrees(const Trajectory& right) {
  TwistIntegrator integrator;
  Trajectory result;
  for (std::size_t i = 1; i < right.size(); ++i) {
    const double seconds = 1e-6 * static_cast<double>(right[i].time_us - right[i - 1].time_us);
    const Pose step = to_pose(conjugate(right[i - 1].pose) * right[i].pose);
    const Twist twist{right[i].time_us, step.translation / seconds,
                      180 / std::numbers::pi * rotation_log(step.rotation) / seconds};
    if (const std::optional<DualQuaternion> pose = integrator.add(twist))
      result.push_back({twist.time_us, canonical_sign(*pose)});
  }
  return result;
}

/// Poses wait for the last one of each `count`, and arrive a millisecond apart.
inline Trajectory buffered(Trajectory trajectory, std::size_t count) {
  const Trajectory measured = trajectory;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const std::size_t last = std::min(i / count * count + count - 1, measured.size() - 1);
    trajectory[i].time_us = measured[last].time_us + static_cast<std::int64_t>(i % count) * 1000;
  }
  return trajectory;
}

/// Mistakes that are neither those of mistakes.hpp nor more of their size.
inline std::vector<Mistake> mistakes_in_rows() {
  const Pose bump{rotation_exp({0, 0, 5 * std::numbers::pi / 180}), {0.05, 0, 0}};
  const auto of_b = [](const std::function<Trajectory(const Trajectory&)>& change) {
    return [change](Streams& s) { s.b = change(s.b); };
  };
  const auto row = [](int later) {
    return [later](const Trajectory& t) { return with_positions_of_row(t, later); };
  };
  const auto turned = [](double part) {
    return [part](const Trajectory& t) { return with_turned_steps(t, part); };
  };
  return {
      {"positions of b a row late", "late_positions_b", of_b(row(-1)), true},
      {"positions of b a row early", "late_positions_b", of_b(row(1)), true},
      {"positions of a a row late", "late_positions_a",
       [](Streams& s) { s.a = with_positions_of_row(s.a, -1); }, true},
      {"steps of b turned by the next attitude", "axes_b", of_b(turned(1)), true},
      {"turning rates of b in degrees", "turning_scale_b", of_b(with_rates_in_degrees)},
      {"rotation vectors of b twice as long", "turning_scale_b", of_b([](const Trajectory& right) {
         return changed(right, [](const Pose& pose) {
           return Pose{rotation_exp(2 * rotation_log(pose.rotation)), pose.translation};
         });
       })},
      {"order of b, inverted", "quaternion_order_b",
       of_b([](const Trajectory& right) { return scalar_first(inverted(right)); })},
      {"b in kilometres", "units", of_b([](const Trajectory& right) { return lengthened(right, 1e-3); })},
      {"times of both in milliseconds", "time_unit",
       [](Streams& s) {
         for (Trajectory* const stream : {&s.a, &s.b})
           for (StampedPose& pose : *stream) pose.time_us /= 1000;
       }},
      {"between the rows of b, those of another odometry", "mixed_frames_b",
       of_b([](const Trajectory& right) { return with_another_sender(right, 1); })},
      {"b in bursts of five", "stamps_b", of_b([](const Trajectory& right) { return buffered(right, 5); })},
      {"b knocked, both inverted", "inverted_both",
       [=](Streams& s) {
         s.a = inverted(s.a);
         s.b = inverted(knocked(s.b, 0.5, bump));
       }},
      // the turn of the part hides in the lever arm or looks like a clock: other codes stand beside this one
      {"b on a part that is steered", "late_positions_b",
       of_b([](const Trajectory& right) { return on_a_steered_part(right, 0.2); }), true}};
}

}  // namespace egocal::testing
