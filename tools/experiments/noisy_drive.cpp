// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/noisy_drive.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "egocal/simulation/simulation.hpp"

namespace egocal::tools {

namespace {

/// SplitMix64 and Box-Muller: the standard's distributions give other numbers in every library.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
  }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  Eigen::Vector3d normal3(double deviation) {
    const double x = normal(), y = normal(), z = normal();
    return deviation * Eigen::Vector3d(x, y, z);
  }

 private:
  std::uint64_t state_;
};

}  // namespace

NoisyDrive::NoisyDrive(const DriveOptions& options, const Pose& T_a_b) {
  SimulationOptions simulation;
  simulation.terrain = Terrain::rough;
  simulation.poses = options.motions + 1;
  simulation.speed = options.step * simulation.rate;
  simulation.roughness = options.roughness;
  simulation.T_vehicle_sensor = {Pose{}, T_a_b};
  simulation.seed = options.seed;
  const std::vector<Trajectory> trajectories = simulate(simulation);
  pairs_ = motions(trajectories[0], trajectories[1]);
  const auto count = static_cast<double>(pairs_.size());
  for (const MotionPair& pair : pairs_)
    for (const auto& [mean, motion] :
         {std::pair<Mean&, const DualQuaternion&>{means_[0], pair.a}, {means_[1], pair.b}}) {
      const Pose pose = to_pose(motion);
      mean.translation += pose.translation.norm() / count;
      mean.rotation += rotation_log(pose.rotation).norm() / count;
    }
}

std::vector<MotionPair> NoisyDrive::run(double relative_noise, bool mixed, std::uint64_t seed) const {
  Numbers random(seed);
  std::vector<MotionPair> pairs = pairs_;
  if (mixed)
    for (MotionPair& pair : pairs) pair = pairs_[random.bits() % pairs_.size()];
  const auto add_noise = [&](DualQuaternion& motion, const Mean& mean) {
    const Eigen::Vector3d turn = random.normal3(relative_noise * mean.rotation);
    const Eigen::Vector3d shift = random.normal3(relative_noise * mean.translation);
    motion = motion * to_dual_quaternion({rotation_exp(turn), shift});
  };
  for (MotionPair& pair : pairs) {
    add_noise(pair.a, means_[0]);
    add_noise(pair.b, means_[1]);
  }
  return pairs;
}

}  // namespace egocal::tools
