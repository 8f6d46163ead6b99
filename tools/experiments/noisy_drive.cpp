// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/noisy_drive.hpp"

#include <utility>

#include "egocal/random.hpp"
#include "egocal/simulation/simulation.hpp"

namespace egocal::tools {

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
  Random random(seed);
  std::vector<MotionPair> pairs = pairs_;
  if (mixed)
    for (MotionPair& pair : pairs) pair = pairs_[random.below(pairs_.size())];
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
