// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "noisy_machines.hpp"

#include <cmath>
#include <vector>

#include "support/random_motion.hpp"

namespace egocal::bench {

namespace {

using testing::Random;
using Vector6 = Eigen::Matrix<double, 6, 1>;  // rotation, then translation

constexpr double period = 0.5;  // [s]
constexpr int substeps = 5;     // a path is smooth between two poses

/// Noise of unit variance of six axes; with a memory [steps] an autoregression that has run for ever.
class UnitNoise {
 public:
  UnitNoise(double memory, bool heavy_tails, Random& random)
      : kept_(memory > 0 ? std::exp(-1 / memory) : 0), heavy_tails_(heavy_tails), random_(random) {
    for (double& value : now_) value = random_.normal();
  }
  Vector6 next() {
    const double fresh = std::sqrt(1 - kept_ * kept_);
    for (double& value : now_) value = kept_ * value + fresh * random_.normal();
    double scale = 1;
    if (heavy_tails_) {
      double squares = 0;
      for (int k = 0; k < 3; ++k) squares += std::pow(random_.normal(), 2);
      scale = 1 / std::sqrt(squares);  // Student's t over the root of its variance, three
    }
    return scale * now_;
  }

 private:
  double kept_;
  bool heavy_tails_;
  Random& random_;
  Vector6 now_;
};

DualQuaternion displaced(const Vector6& by) {
  return testing::displacement(by.head<3>(), by.tail<3>());
}

/// Motions of the body.
std::vector<DualQuaternion> path(const Machine& machine, int motions, bool plane, Random& random) {
  UnitNoise process(machine.fades * substeps / period, false, random);
  const double phase = random.uniform(0, 2);
  std::vector<DualQuaternion> steps;
  for (int i = 0; i < motions; ++i) {
    DualQuaternion step;
    for (int k = 0; k < substeps; ++k) {
      const Vector6 now = process.next();
      Eigen::Vector3d w(machine.tilt * now[0], machine.tilt * now[1], machine.yaw * now[2]);
      Eigen::Vector3d v(machine.speed + machine.variation * now[3], machine.variation * now[4],
                        machine.variation * now[5]);
      if (machine.has_ground) v.tail<2>().setZero();
      if (machine.stops > 0) {
        const double cycle =
            std::fmod((i + static_cast<double>(k) / substeps) * period / machine.stops + phase, 1);
        const bool stands = cycle < 0.4;
        // a robot turns while it stands, a car does not
        if (stands) v.setZero();
        if (stands != (machine.speed < 2)) w[2] *= 0.1;
      }
      if (plane) w.head<2>().setZero();
      constexpr double dt = period / substeps;
      step = step * testing::displacement(dt * w, dt * v);
    }
    steps.push_back(step);
  }
  return steps;
}

/// Rotation and translation of each motion, or the mean ones of all.
Vector6 size_of(const DualQuaternion& motion) {
  Vector6 size;
  size << Eigen::Vector3d::Constant(egocal::rotation_angle(motion)),
      Eigen::Vector3d::Constant(to_pose(motion).translation.norm());
  return size;
}

Trajectory measured(const std::vector<DualQuaternion>& steps, const DualQuaternion& mount,
                    const DriveNoise& noise, double of_motions, double of_poses, Random& random) {
  std::vector<DualQuaternion> motions;
  Vector6 mean = Vector6::Zero();
  for (const DualQuaternion& step : steps) {
    motions.push_back(conjugate(mount) * step * mount);
    mean += size_of(motions.back()) / static_cast<double>(steps.size());
  }
  UnitNoise on_motions(noise.memory, noise.heavy_tails, random);
  UnitNoise on_poses(noise.memory, noise.heavy_tails, random);
  Trajectory trajectory;
  DualQuaternion pose;
  for (std::size_t i = 0; i <= motions.size(); ++i) {
    const DualQuaternion seen = pose * displaced(of_poses * mean.cwiseProduct(on_poses.next()));
    trajectory.push_back(
        {static_cast<std::int64_t>(std::llround(1e6 * period * static_cast<double>(i))), normalized(seen)});
    if (i == motions.size()) break;
    const Vector6 scale = of_motions * mean + noise.of_each * size_of(motions[i]);
    pose = pose * motions[i] * displaced(scale.cwiseProduct(on_motions.next()));
  }
  return trajectory;
}

/// Anywhere on the machine, tilted by a few degrees.
Pose mount(Random& random) {
  const Eigen::Vector3d tilt = random.normal3(0.05), place = random.normal3(0.7);
  const double yaw = random.uniform(-1.5, 1.5);
  Pose pose{rotation_exp(tilt) * rotation_exp({0, 0, yaw}), place};
  pose.translation.z() += 1.5;
  return pose;
}

GroundPlane ground_below(const Pose& T_vehicle_sensor) {
  return {T_vehicle_sensor.rotation.conjugate() * Eigen::Vector3d::UnitZ(),
          -T_vehicle_sensor.translation.z()};
}

}  // namespace

testing::Streams noisy_drive(const Machine& machine, const DriveNoise& noise, int motions, bool plane,
                             std::uint64_t seed) {
  Random random(seed);
  const Pose T_a = mount(random), T_b = mount(random);
  const std::vector<DualQuaternion> steps = path(machine, motions, plane, random);
  testing::Streams streams;
  streams.T = to_dual_quaternion(inverse(T_a) * T_b);
  streams.a = measured(steps, to_dual_quaternion(T_a), noise, noise.motions_a, noise.poses_a, random);
  streams.b = measured(steps, to_dual_quaternion(T_b), noise, noise.motions_b, noise.poses_b, random);
  if (plane) {
    streams.options.mode = Mode::planar;
    streams.options.plane_a = ground_below(T_a);
    streams.options.plane_b = ground_below(T_b);
  }
  return streams;
}

}  // namespace egocal::bench
