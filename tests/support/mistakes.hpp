// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What users do to right trajectories before they calibrate with them.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "random_motion.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

inline Trajectory changed(Trajectory trajectory, const std::function<Pose(const Pose&)>& change) {
  for (StampedPose& stamped : trajectory)
    stamped.pose = canonical_sign(to_dual_quaternion(change(to_pose(stamped.pose))));
  return trajectory;
}

inline Trajectory inverted(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) { return inverse(pose); });
}

/// Headings of a compass that turns `factor` times as far as it should, about the axis of its world that most
/// of the turning is about: the vertical. Positions are right.
inline Trajectory with_turning_scale(Trajectory trajectory, double factor) {
  std::vector<Eigen::Vector3d> turns{Eigen::Vector3d::Zero()};
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    turns.push_back(rotation_log(to_pose(trajectory[i].pose).rotation *
                                 to_pose(trajectory[i - 1].pose).rotation.conjugate()));
  Eigen::Vector3d axis(0.3, 0.5, 0.8);
  for (int round = 0; round < 100; ++round) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& turn : turns) sum += axis.dot(turn) * turn;
    axis = sum.normalized();
  }
  double turned = 0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    turned += axis.dot(turns[i]);
    const Pose pose = to_pose(trajectory[i].pose);
    trajectory[i].pose = canonical_sign(to_dual_quaternion(
        Pose{rotation_exp((factor - 1) * turned * axis) * pose.rotation, pose.translation}));
  }
  return trajectory;
}

/// Positions moved by a lever arm of the body [m] with the rotations from the world to the body.
inline Trajectory with_turned_lever_arm(const Trajectory& trajectory, const Eigen::Vector3d& arm) {
  return changed(trajectory, [&arm](const Pose& pose) {
    return Pose{pose.rotation, pose.translation + pose.rotation.conjugate() * arm};
  });
}

/// Columns w x y z in a file whose readers expect x y z w, and the other way round.
inline Trajectory scalar_first(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    return Pose{Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()), pose.translation};
  });
}
inline Trajectory scalar_last(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    return Pose{Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
  });
}

inline Trajectory lengthened(const Trajectory& trajectory, double factor) {
  return changed(trajectory, [=](const Pose& pose) {
    return Pose{pose.rotation, factor * pose.translation};
  });
}

/// The position's columns alone.
inline Trajectory with_position_columns(const Trajectory& trajectory, const Eigen::Matrix3d& P) {
  return changed(trajectory, [&](const Pose& pose) { return Pose{pose.rotation, P * pose.translation}; });
}

inline Trajectory with_inverse_rotations(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    return Pose{pose.rotation.conjugate(), pose.translation};
  });
}

/// Stamps later by offset [s] and growing by rate [s/s].
inline Trajectory late(Trajectory trajectory, double offset, double rate = 0) {
  const std::int64_t first = trajectory.front().time_us;
  for (StampedPose& pose : trajectory)
    pose.time_us += std::llround(1e6 * offset + rate * static_cast<double>(pose.time_us - first));
  return trajectory;
}

/// From a part of the drive on, the sensor looks and sits differently: T_old_new.
inline Trajectory knocked(Trajectory trajectory, double part, const Pose& T_old_new) {
  const auto first = static_cast<std::size_t>(part * static_cast<double>(trajectory.size()));
  const DualQuaternion change = to_dual_quaternion(T_old_new);
  for (std::size_t i = first; i < trajectory.size(); ++i)
    trajectory[i].pose = canonical_sign(normalized(trajectory[i].pose * change));
  return trajectory;
}

/// Every pose the mean of its neighbours: a filter without lag.
inline Trajectory smoothed(const Trajectory& trajectory, std::size_t reach) {
  Trajectory result = trajectory;
  for (std::size_t i = reach; i + reach < trajectory.size(); ++i) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
    for (std::size_t k = i - reach; k <= i + reach; ++k) {
      const Pose pose = to_pose(trajectory[k].pose);
      const Eigen::Vector4d q = trajectory[k].pose.real;
      position += pose.translation;
      rotation += q.dot(trajectory[i].pose.real) < 0 ? Eigen::Vector4d(-q) : q;
    }
    rotation.normalize();
    const Pose mean{Rotation(rotation[0], rotation[1], rotation[2], rotation[3]),
                    position / static_cast<double>(2 * reach + 1)};
    result[i].pose = canonical_sign(to_dual_quaternion(mean));
  }
  return result;
}

/// The last pose before [begin, end) of the drive again and again.
inline Trajectory frozen(Trajectory trajectory, double begin, double end) {
  const auto n = static_cast<double>(trajectory.size());
  const auto first = static_cast<std::size_t>(begin * n), last = static_cast<std::size_t>(end * n);
  for (std::size_t i = first; i < last; ++i) trajectory[i].pose = trajectory[first].pose;
  return trajectory;
}

/// The poses in the opposite order.
inline Trajectory backwards(Trajectory trajectory) {
  for (std::size_t i = 0, k = trajectory.size() - 1; i < k; ++i, --k)
    std::swap(trajectory[i].pose, trajectory[k].pose);
  return trajectory;
}

/// From half of the drive on, the motions of its first half again: of another drive.
inline Trajectory half_of_another(Trajectory trajectory) {
  const std::size_t half = trajectory.size() / 2;
  const DualQuaternion start = trajectory[half].pose * conjugate(trajectory[0].pose);
  const Trajectory given = trajectory;
  for (std::size_t i = half; i < trajectory.size(); ++i)
    trajectory[i].pose = canonical_sign(normalized(start * given[i - half].pose));
  return trajectory;
}

/// A vehicle that took another way, at the stamps that are given.
inline Trajectory of_another_drive(Trajectory trajectory) {
  SimulationOptions options;
  options.terrain = Terrain::rough;
  options.poses = static_cast<int>(trajectory.size());
  options.relative_noise = 0.01;
  options.seed = 1000 + trajectory.size();
  const Trajectory other = simulated_drive(options).b;
  for (std::size_t i = 0; i < std::min(other.size(), trajectory.size()); ++i)
    trajectory[i].pose = other[i].pose;
  return trajectory;
}

/// Every pose that of its own position, but in the frame of the sensor: the position of the inverse pose.
inline Trajectory with_inverse_positions(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) { return Pose{pose.rotation, inverse(pose).translation}; });
}

/// Of a left-handed world and body: y is on the other side.
inline Trajectory mirrored(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    const Eigen::Vector3d& t = pose.translation;
    return Pose{Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), {t.x(), -t.y(), t.z()}};
  });
}

/// Rotation vectors in degrees, read as radians.
inline Trajectory with_angles_in_degrees(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Vector3d turned = 180 / std::numbers::pi * rotation_log(pose.rotation);
    return Pose{rotation_exp(turned), pose.translation};
  });
}

/// Roll, pitch and yaw applied in the opposite order.
inline Trajectory with_angles_in_another_order(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) {
    const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
    const double roll = std::atan2(R(2, 1), R(2, 2)), yaw = std::atan2(R(1, 0), R(0, 0));
    const double pitch = std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2)));
    const Eigen::Quaterniond q =
        rotation_exp({roll, 0, 0}) * rotation_exp({0, pitch, 0}) * rotation_exp({0, 0, yaw});
    return Pose{q.normalized(), pose.translation};
  });
}

/// Roll, pitch and yaw [rad] as a program changed them: R = Rz(yaw) Ry(pitch) Rx(roll).
inline Trajectory with_angles(const Trajectory& trajectory,
                              const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& change) {
  return changed(trajectory, [&](const Pose& pose) {
    const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
    const Eigen::Vector3d x =
        change({std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))),
                std::atan2(R(1, 0), R(0, 0))});
    const Eigen::Quaterniond q =
        rotation_exp({0, 0, x[2]}) * rotation_exp({0, x[1], 0}) * rotation_exp({x[0], 0, 0});
    return Pose{q.normalized(), pose.translation};
  });
}

/// Each step turned by a factor, and summed up with the wrong rotations: half or double angles of a
/// gyroscope.
inline Trajectory with_scaled_steps(const Trajectory& trajectory, double factor) {
  Trajectory result = trajectory;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    Pose step = to_pose(conjugate(trajectory[i - 1].pose) * trajectory[i].pose);
    step.rotation = rotation_exp(factor * rotation_log(step.rotation));
    result[i].pose = canonical_sign(normalized(result[i - 1].pose * to_dual_quaternion(step)));
  }
  return result;
}

/// Velocities in the axes of the world [m/s] where positions should be.
inline Trajectory with_velocities(const Trajectory& trajectory) {
  Trajectory result = trajectory;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose before = to_pose(trajectory[i - 1].pose), pose = to_pose(trajectory[i].pose);
    const double seconds = 1e-6 * static_cast<double>(trajectory[i].time_us - trajectory[i - 1].time_us);
    result[i].pose = canonical_sign(
        to_dual_quaternion({pose.rotation, (pose.translation - before.translation) / seconds}));
  }
  if (result.size() > 1) result[0].pose = result[1].pose;
  return result;
}

/// Stamps rounded down to whole multiples [us], as a number with few digits keeps them.
inline Trajectory with_rounded_stamps(Trajectory trajectory, std::int64_t multiple) {
  const std::int64_t first = trajectory.front().time_us;
  for (StampedPose& pose : trajectory) pose.time_us -= (pose.time_us - first) % multiple;
  Trajectory result;
  for (const StampedPose& pose : trajectory)
    if (result.empty() || pose.time_us > result.back().time_us) result.push_back(pose);
  return result;
}

/// Every n-th pose, and between them what a straight line says.
inline Trajectory interpolated(Trajectory trajectory, std::size_t n) {
  for (std::size_t i = 0; i + n < trajectory.size(); i += n) {
    const Pose from = to_pose(trajectory[i].pose), to = to_pose(trajectory[i + n].pose);
    for (std::size_t k = 1; k < n; ++k) {
      const double part = static_cast<double>(k) / static_cast<double>(n);
      const Eigen::Quaterniond q0 = from.rotation, q1 = to.rotation;
      const Eigen::Vector3d position = (1 - part) * from.translation + part * to.translation;
      trajectory[i + k].pose = canonical_sign(to_dual_quaternion({q0.slerp(part, q1), position}));
    }
  }
  return trajectory;
}

/// The scale of each motion grows evenly by `growth` over the drive.
inline Trajectory with_growing_scale(const Trajectory& trajectory, double growth) {
  Trajectory result = trajectory;
  Eigen::Vector3d position = to_pose(trajectory.front().pose).translation;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose before = to_pose(trajectory[i - 1].pose), pose = to_pose(trajectory[i].pose);
    const double part = static_cast<double>(i) / static_cast<double>(trajectory.size());
    position += (1 + growth * part) * (pose.translation - before.translation);
    result[i].pose = canonical_sign(to_dual_quaternion({pose.rotation, position}));
  }
  return result;
}

/// From the middle of the drive on, stamps later by this [us].
inline Trajectory late_from_the_middle(Trajectory trajectory, std::int64_t later) {
  for (std::size_t i = trajectory.size() / 2; i < trajectory.size(); ++i) trajectory[i].time_us += later;
  return trajectory;
}

/// The odometry starts again in the middle of the drive. No mistake, but a motion that is none.
inline Trajectory restarted(Trajectory trajectory) {
  const DualQuaternion there = conjugate(trajectory[trajectory.size() / 2].pose);
  for (std::size_t i = trajectory.size() / 2; i < trajectory.size(); ++i)
    trajectory[i].pose = canonical_sign(normalized(there * trajectory[i].pose));
  return trajectory;
}

/// A road drive of another vehicle, with the stamps of this one.
inline Trajectory of_another_vehicle(const Trajectory& trajectory) {
  SimulationOptions options;
  options.poses = static_cast<int>(trajectory.size());
  options.relative_noise = 0.01;
  options.seed = 4711;
  Trajectory other = simulated_drive(options).b;
  for (std::size_t i = 0; i < other.size(); ++i) other[i].time_us = trajectory[i].time_us;
  return other;
}

/// The motions as another frame of the same body has them.
inline Trajectory seen_from(const Trajectory& trajectory, const DualQuaternion& T) {
  Trajectory result = trajectory;
  for (StampedPose& pose : result) pose.pose = canonical_sign(normalized(T * pose.pose * conjugate(T)));
  return result;
}

/// A slow sensor whose last pose is repeated at every stamp: one new pose in n.
inline Trajectory held(Trajectory trajectory, std::size_t n) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) trajectory[i].pose = trajectory[i - i % n].pose;
  return trajectory;
}

enum class Half { positions, rotations };

/// With that half of each pose as it was the given number of poses before.
template <typename PosesBefore>
Trajectory with_half_of_earlier(const Trajectory& trajectory, Half half, const PosesBefore& poses_before) {
  Trajectory result = trajectory;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    Pose pose = to_pose(trajectory[i].pose);
    const Pose earlier = to_pose(trajectory[i - poses_before(i)].pose);
    if (half == Half::positions)
      pose.translation = earlier.translation;
    else
      pose.rotation = earlier.rotation;
    result[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  return result;
}

inline Trajectory with_late(const Trajectory& trajectory, Half half, std::size_t poses) {
  return with_half_of_earlier(trajectory, half, [poses](std::size_t i) { return std::min(i, poses); });
}

/// Positions as they were some poses before: of another sensor than the rotations, with a delay.
inline Trajectory with_late_positions(const Trajectory& trajectory, std::size_t poses) {
  return with_late(trajectory, Half::positions, poses);
}

/// The same of the rotations.
inline Trajectory with_late_rotations(const Trajectory& trajectory, std::size_t poses) {
  return with_late(trajectory, Half::rotations, poses);
}

inline Trajectory with_held(const Trajectory& trajectory, Half half, std::size_t n) {
  return with_half_of_earlier(trajectory, half, [n](std::size_t i) { return i % n; });
}

/// Positions of a slow receiver, each held for n rows of fast rotations.
inline Trajectory with_held_positions(const Trajectory& trajectory, std::size_t n) {
  return with_held(trajectory, Half::positions, n);
}

/// The same of the rotations.
inline Trajectory with_held_rotations(const Trajectory& trajectory, std::size_t n) {
  return with_held(trajectory, Half::rotations, n);
}

/// A causal filter of first order; each pose keeps this part of the one before.
inline Trajectory low_passed(Trajectory trajectory, double kept) {
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose before = to_pose(trajectory[i - 1].pose), pose = to_pose(trajectory[i].pose);
    const Eigen::Quaterniond q0 = before.rotation, q1 = pose.rotation;
    const Eigen::Vector3d position = kept * before.translation + (1 - kept) * pose.translation;
    trajectory[i].pose = canonical_sign(to_dual_quaternion({q0.slerp(1 - kept, q1), position}));
  }
  return trajectory;
}

/// From the middle of the drive on, every motion longer by this factor.
inline Trajectory longer_from_the_middle(Trajectory trajectory, double factor) {
  const std::size_t middle = trajectory.size() / 2;
  const Eigen::Vector3d there = to_pose(trajectory[middle].pose).translation;
  for (std::size_t i = middle; i < trajectory.size(); ++i) {
    const Pose pose = to_pose(trajectory[i].pose);
    const Eigen::Vector3d position = there + factor * (pose.translation - there);
    trajectory[i].pose = canonical_sign(to_dual_quaternion({pose.rotation, position}));
  }
  return trajectory;
}

struct Mistake {
  std::string name;
  std::string code;  ///< of the finding that names it; empty: none has to
  std::function<void(Streams&)> make;
};

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
  const Pose bump{rotation_exp({0, 0, 5 * std::numbers::pi / 180}), {0.05, 0, 0}};
  return {
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
      {"rotations of b held for three rows", "held_b",
       [](Streams& s) { s.b = with_held_rotations(s.b, 3); }}};
}

/// The last of these, of rows: a few seconds do not show them. Late positions are none of them: at the one
/// speed of simulated cars they are another lever arm (docs/trust.md, "What no verdict can detect").
inline constexpr std::size_t mistakes_of_rows = 3;

}  // namespace egocal::testing
