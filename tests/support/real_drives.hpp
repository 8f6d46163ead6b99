// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is known of the real drives in data_dir(). Their licences do not allow copies here.
#pragma once

#include <filesystem>
#include <string>

#include "egocal/geometry/pose.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "paths.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

inline bool have_real_drives() {
  return std::filesystem::exists(paths::data_dir());
}

inline Trajectory real_trajectory(const std::string& name) {
  return read_trajectory(std::string(paths::data_dir() + "/") + name);
}

/// Pose of KITTI's left camera in its lidar, and its ground planes.
inline const DualQuaternion kitti_truth = to_dual_quaternion(
    {Eigen::Quaterniond(0.499924473812, -0.499145921532, 0.504084765332, -0.496817289214).normalized(),
     {0.333504767535, -0.00479610810717, -0.0755785517707}});
inline PairingOptions kitti_planar(PairingOptions options) {
  options.mode = Mode::planar;
  options.plane_a = {{-1.220921993720055186e-02, 2.798845739362088372e-03, 9.999215476281387849e-01},
                     -1.779603641715662210};
  options.plane_b = {{-6.613857662736873089e-03, -9.998207740635888241e-01, -1.773912730951216279e-02},
                     -1.684677553916568593};
  return options;
}

/// Pose of the robot arm's eye in its hand: not a truth, but the estimate that came with the data.
inline const DualQuaternion arm_reference = to_dual_quaternion(
    {Eigen::Quaterniond(0.600112895337, -0.605573525678, 0.371519644521, -0.367584509445).normalized(),
     {-0.00245036495877, -0.0184887305911, 0.00211597057302}});

inline Streams kitti(const std::string& drive, const std::string& lidar = "velodyne_pylidar") {
  return {kitti_truth,
          real_trajectory("kitti_" + drive + "/" + lidar + ".tum"),
          real_trajectory("kitti_" + drive + "/cam0_orbslam2.tum"),
          {}};
}
inline Streams kitti_asynchronous() {
  return {kitti_truth,
          real_trajectory("kitti0930_27_async/velodyne.tum"),
          real_trajectory("kitti0930_27_async/cam0.tum"),
          {}};
}
inline Streams euroc() {
  return {{}, real_trajectory("euroc_v2_01/body_gt.tum"), real_trajectory("euroc_v2_01/body_vio.tum"), {}};
}
inline Streams robot_arm() {
  return {arm_reference,
          real_trajectory("eth_robot_arm_real/hand.tum"),
          real_trajectory("eth_robot_arm_real/eye.tum"),
          {}};
}
inline Streams planar(Streams streams) {
  streams.options = kitti_planar(streams.options);
  return streams;
}

}  // namespace egocal::testing
