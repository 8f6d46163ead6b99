// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What users do to right trajectories before they calibrate with them.
#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "mistake.hpp"
#include "mistakes_of_clocks.hpp"
#include "mistakes_of_frames.hpp"
#include "mistakes_of_rows.hpp"
#include "mistakes_of_streams.hpp"
#include "mistakes_of_units.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

inline std::vector<Mistake> mistakes() {
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity(), exchange, cycle;
  mirror(1, 1) = -1;
  exchange << 0, 1, 0, 1, 0, 0, 0, 0, 1;
  cycle << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const Eigen::Matrix3d flat = Eigen::Vector3d(1, 1, 0).asDiagonal();
  const Eigen::Matrix3d halved = Eigen::Vector3d(1, 1, 0.5).asDiagonal();
  const Eigen::Matrix3d longer = Eigen::Vector3d(1.3, 1, 1).asDiagonal();
  const Eigen::Matrix3d in_feet = Eigen::Vector3d(1, 1, 3.2808).asDiagonal();
  const Eigen::Matrix3d in_degrees = Eigen::Vector3d(1 / 71e3, 1 / 111e3, 1).asDiagonal();
  const Eigen::Matrix3d turn = rotation_exp({0.1, 0, 0.7}).toRotationMatrix();
  const Pose round{rotation_exp({0, 0, std::numbers::pi}), {0.1, 0, 0}};
  const Pose aside{rotation_exp({0, 0.5, 70 * std::numbers::pi / 180}), {0, 0.1, 0}};
  const Pose metre_aside{Rotation::Identity(), {0.6, 0.8, 0}};
  const Pose turned{rotation_exp({0, 0, 2 * std::numbers::pi / 180}), Eigen::Vector3d::Zero()};
  const Pose bump{rotation_exp({0, 0, 5 * std::numbers::pi / 180}), {0.05, 0, 0}};
  std::vector<Mistake> all{
      {"none", "", [](Streams&) {}},
      {"a inverted", "inverted_a", [](Streams& s) { s.a = inverted(s.a); }},
      {"b inverted", "inverted_b", [](Streams& s) { s.b = inverted(s.b); }},
      {"both inverted", "inverted_both",
       [](Streams& s) {
         s.a = inverted(s.a);
         s.b = inverted(s.b);
       }},
      {"order of a", "quaternion_order_a", [](Streams& s) { s.a = scalar_first(s.a); }},
      {"order of b", "quaternion_order_b", [](Streams& s) { s.b = scalar_first(s.b); }},
      {"other order of b", "quaternion_order_b", [](Streams& s) { s.b = scalar_last(s.b); }},
      {"order of both", "quaternion_order_both",
       [](Streams& s) {
         s.a = scalar_first(s.a);
         s.b = scalar_first(s.b);
       }},
      {"scale 0.37", "scale", [](Streams& s) { s.b = lengthened(s.b, 0.37); }},
      {"scale 1.05", "scale", [](Streams& s) { s.b = lengthened(s.b, 1.05); }},
      {"b in millimetres", "units", [](Streams& s) { s.b = lengthened(s.b, 1000); }},
      {"a in millimetres", "units", [](Streams& s) { s.a = lengthened(s.a, 1000); }},
      {"clock 0.02 s off", "clock_offset", [](Streams& s) { s.b = late(s.b, 0.02); }},
      {"clock 0.5 s off", "clock_offset", [](Streams& s) { s.b = late(s.b, 0.5); }},
      {"clock 0.1 % fast", "clock_drift", [](Streams& s) { s.b = late(s.b, 0, 1e-3); }},
      {"y of b mirrored", "axes_b", [=](Streams& s) { s.b = with_position_columns(s.b, mirror); }},
      {"x and y of b exchanged", "axes_b", [=](Streams& s) { s.b = with_position_columns(s.b, exchange); }},
      {"x and y of a exchanged", "axes_a", [=](Streams& s) { s.a = with_position_columns(s.a, exchange); }},
      {"rotations of b inverse", "axes_b", [](Streams& s) { s.b = with_inverse_rotations(s.b); }},
      {"b knocked in the middle", "mount_moved", [=](Streams& s) { s.b = knocked(s.b, 0.5, bump); }},
      {"b knocked late", "mount_moved", [=](Streams& s) { s.b = knocked(s.b, 0.75, bump); }},
      {"clock 3 s off", "clock_offset", [](Streams& s) { s.b = late(s.b, 3); }},
      {"scale 1.02", "scale", [](Streams& s) { s.b = lengthened(s.b, 1.02); }},
      {"x, y, z of b from y, z, x", "axes_b", [=](Streams& s) { s.b = with_position_columns(s.b, cycle); }},
      {"position of b turned 40 deg", "axes_b", [=](Streams& s) { s.b = with_position_columns(s.b, turn); }},
      {"inverse position of a", "axes_a", [](Streams& s) { s.a = with_inverse_positions(s.a); }},
      {"z of b always 0", "flat_b", [=](Streams& s) { s.b = with_position_columns(s.b, flat); }},
      {"z of b halved", "", [=](Streams& s) { s.b = with_position_columns(s.b, halved); }},
      {"b given twice", "same_stream", [](Streams& s) { s.a = s.b; }},
      {"b frozen for a third", "frozen_b", [](Streams& s) { s.b = frozen(s.b, 0.4, 0.73); }},
      {"b half of another drive", "unrelated", [](Streams& s) { s.b = half_of_another(s.b); }},
      {"b backwards", "", [](Streams& s) { s.b = backwards(s.b); }},
      {"b smoothed", "", [](Streams& s) { s.b = smoothed(s.b, 5); }},
      {"b inverted, scale 0.37", "inverted_b", [](Streams& s) { s.b = lengthened(inverted(s.b), 0.37); }},
      {"first 5 s", "",
       [](Streams& s) {
         const std::int64_t end = s.a.front().time_us + 5'000'000;
         for (Trajectory* t : {&s.a, &s.b}) {
           while (t->size() > 2 && t->back().time_us > end) t->pop_back();
         }
       }},
      {"b left-handed", "", [](Streams& s) { s.b = mirrored(s.b); }},
      {"angles of b in degrees", "", [](Streams& s) { s.b = with_angles_in_degrees(s.b); }},
      {"roll, pitch, yaw of b in another order", "",
       [](Streams& s) { s.b = with_angles_in_another_order(s.b); }},
      {"stamps of b rounded to 0.25 s", "", [](Streams& s) { s.b = with_rounded_stamps(s.b, 250'000); }},
      {"every 10th pose of b, interpolated", "undersampled_b",
       [](Streams& s) { s.b = interpolated(s.b, 10); }},
      {"scale of b grows by 10 %", "", [](Streams& s) { s.b = with_growing_scale(s.b, 0.1); }},
      {"b 0.3 s late from the middle on", "", [](Streams& s) { s.b = late_from_the_middle(s.b, 300'000); }},
      {"odometry of b starts anew", "", [](Streams& s) { s.b = restarted(s.b); }},
      {"b of another vehicle", "", [](Streams& s) { s.b = of_another_vehicle(s.b); }},
      {"b already in the frame of a", "same_stream", [](Streams& s) { s.b = seen_from(s.b, s.T); }},
      {"b turned round in the middle", "mount_moved", [=](Streams& s) { s.b = knocked(s.b, 0.5, round); }},
      {"b turned aside early", "mount_moved", [=](Streams& s) { s.b = knocked(s.b, 0.2, aside); }},
      {"b turned aside late", "mount_moved", [=](Streams& s) { s.b = knocked(s.b, 0.8, aside); }},
      {"b without positions", "missing_b", [](Streams& s) { s.b = lengthened(s.b, 0); }},
      {"b without rotations", "missing_b",
       [](Streams& s) {
         s.b = changed(s.b, [](const Pose& pose) { return Pose{Rotation::Identity(), pose.translation}; });
       }},
      {"positions of b 0.3 s late", "", [](Streams& s) { s.b = with_late_positions(s.b, 3); }},
      {"b low-passed, 1 s", "", [](Streams& s) { s.b = low_passed(s.b, 0.905); }},
      {"b holds each third pose", "", [](Streams& s) { s.b = held(s.b, 3); }},
      {"b holds each tenth pose", "", [](Streams& s) { s.b = held(s.b, 10); }},
      {"stamps of b rounded to 1 s", "", [](Streams& s) { s.b = with_rounded_stamps(s.b, 1'000'000); }},
      {"scale of b 1.15 from the middle on", "scale_change",
       [](Streams& s) { s.b = longer_from_the_middle(s.b, 1.15); }},
      {"b of another drive", "unrelated", [](Streams& s) { s.b = of_another_drive(s.b); }},
      {"rotations of both inverse", "axes_both",
       [](Streams& s) {
         s.a = with_inverse_rotations(s.a);
         s.b = with_inverse_rotations(s.b);
       }},
      {"x, y, z of both from y, z, x", "axes_both",
       [=](Streams& s) {
         s.a = with_position_columns(s.a, cycle);
         s.b = with_position_columns(s.b, cycle);
       }},
      {"lever arm of b by the inverse rotation", "axes_b",
       [](Streams& s) {
         s.b = with_turned_lever_arm(s.b, {0.3, 1.5, 0.5});
       }},
      {"headings of b 1.05 times too far", "turning_scale_b",
       [](Streams& s) { s.b = with_turning_scale(s.b, 1.05); }},
      {"gyroscope of b in half angles", "turning_scale_b",
       [](Streams& s) { s.b = with_scaled_steps(s.b, 0.5); }},
      {"b in latitude and longitude", "axes_b",
       [=](Streams& s) { s.b = with_position_columns(s.b, in_degrees); }},
      {"z of b in feet", "axes_b", [=](Streams& s) { s.b = with_position_columns(s.b, in_feet); }},
      {"x of b 1.3 times too long", "axes_b", [=](Streams& s) { s.b = with_position_columns(s.b, longer); }},
      {"yaw of b a compass heading", "axes_b",
       [](Streams& s) {
         s.b = with_angles(s.b, [](const Eigen::Vector3d& x) {
           return Eigen::Vector3d(x[0], x[1], std::numbers::pi / 2 - x[2]);
         });
       }},
      {"roll and yaw of b exchanged", "axes_b",
       [](Streams& s) {
         s.b = with_angles(s.b, [](const Eigen::Vector3d& x) { return Eigen::Vector3d(x[2], x[1], x[0]); });
       }},
      {"velocities of b as positions", "", [](Streams& s) { s.b = with_velocities(s.b); }},
      {"b without roll and pitch", "",
       [](Streams& s) {
         s.b = with_angles(s.b, [](const Eigen::Vector3d& x) { return Eigen::Vector3d(0, 0, x[2]); });
       }},
      {"rotations of b a row late", "", [](Streams& s) { s.b = with_late_rotations(s.b, 1); }},
      {"positions of b held for three rows", "held_b", [](Streams& s) { s.b = with_held_positions(s.b, 3); }},
      {"rotations of b held for three rows", "held_b", [](Streams& s) { s.b = with_held_rotations(s.b, 3); }},
      {"every second pose of b a metre aside", "mixed_frames_b",
       [=](Streams& s) { s.b = with_another_frame(s.b, metre_aside, every(2)); }},
      {"every third pose of a turned by 2 deg", "mixed_frames_a",
       [=](Streams& s) { s.a = with_another_frame(s.a, turned, every(3)); }},
      {"a third of the poses of a, at random, a metre aside", "mixed_frames_a",
       [=](Streams& s) { s.a = with_another_frame(s.a, metre_aside, at_random(1.0 / 3, 1)); }},
      {"a third of the poses of b, at random, a metre aside and turned by 2 deg", "mixed_frames_b",
       [=](Streams& s) { s.b = with_another_frame(s.b, metre_aside * turned, at_random(1.0 / 3, 2)); }}};
  for (Mistake& mistake : mistakes_in_rows()) all.push_back(std::move(mistake));
  return all;
}

/// The last of these, of rows: a few seconds do not show them.
inline const std::size_t mistakes_of_rows = 7 + mistakes_in_rows().size();

}  // namespace egocal::testing
