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

/// Every pose that of its own position, but in the frame of the sensor: the position of the inverse pose.
inline Trajectory with_inverse_positions(const Trajectory& trajectory) {
  return changed(trajectory, [](const Pose& pose) { return Pose{pose.rotation, inverse(pose).translation}; });
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
  const Eigen::Matrix3d turn = rotation_exp({0.1, 0, 0.7}).toRotationMatrix();
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
  };
}

}  // namespace egocal::testing
