// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The choice between motions of several strides, and between them and their sum.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/pairing/selection.hpp"
#include "egocal/problem/blocks.hpp"

namespace egocal {
namespace {

using testing::displacement;
using testing::Random;
using testing::random_pairs;

std::vector<Statistics> blocks_of(const DualQuaternion& T, std::size_t pairs, double noise, std::uint64_t seed) {
  Random random(seed);
  BlockStatistics blocks;
  for (const MotionPair& pair : random_pairs(T, {.pairs = pairs, .noise = noise}, random)) blocks.add(pair);
  return blocks.inliers();
}

/// Which of three strides is chosen where steps are precise but see another extrinsic.
int chosen_stride(const Eigen::Vector3d& error_of_steps, std::uint64_t seed) {
  const DualQuaternion T = displacement({0.4, -1.1, 0.7}, {0.5, -2, 1.2});
  const DualQuaternion of_steps = displacement({0, 0, 0}, error_of_steps) * T;
  const std::vector<Candidate> candidates = {{1, {1, 1}, blocks_of(of_steps, 1200, 0.002, 3 * seed)},
                                             {2, {1, 1}, blocks_of(T, 600, 0.01, 3 * seed + 1)},
                                             {4, {1, 1}, blocks_of(T, 300, 0.02, 3 * seed + 2)}};
  const std::optional<Selection> selection = select_candidate({}, candidates, std::nullopt);
  return selection ? candidates[selection->index].stride : 0;
}

TEST(Selection, PreciseStepsAreTakenWhereLongerMotionsAgree) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) EXPECT_EQ(chosen_stride({0, 0, 0}, seed), 1) << seed;
}

TEST(Selection, StepsThatLongerMotionsContradictAreRefused) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) EXPECT_EQ(chosen_stride({0, 0, 0.02}, seed), 2) << seed;
}

/// A car on a road that shakes it faster than its sensors measure.
struct Shaken {
  std::array<double, 12> frequency{}, phase{}, pitch{}, roll{};

  explicit Shaken(Random& random) {
    for (std::size_t i = 0; i < frequency.size(); ++i) {
      frequency[i] = 0.6 * std::pow(10.0, static_cast<double>(i) / 11);  // to 6 Hz
      phase[i] = random.uniform(0, 2 * std::numbers::pi);
      pitch[i] = 0.0025 * random.normal();
      roll[i] = 0.0025 * random.normal();
    }
  }

  Eigen::Quaterniond rotation(double t) const {
    double up = 0, aside = 0;
    for (std::size_t i = 0; i < frequency.size(); ++i) {
      const double wave = 2 * std::numbers::pi * frequency[i] * t + phase[i];
      up += pitch[i] * std::sin(wave);
      aside += roll[i] * std::cos(wave);
    }
    return rotation_exp({0, 0, 0.3 * std::sin(0.05 * t)}) * rotation_exp({aside, up, 0});
  }
};

Trajectory odometry(const Shaken& car, const DualQuaternion& mount, double rate, double first,
                    Random& random) {
  constexpr double step = 0.0025, duration = 300, speed = 12;
  Trajectory result;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  DualQuaternion before, measured;
  double next = first;
  for (double t = 0; t < duration; t += step) {
    const Eigen::Quaterniond rotation = car.rotation(t);
    if (t >= next - 1e-9) {
      next += 1 / rate;
      const DualQuaternion here = to_dual_quaternion({rotation, place}) * mount;
      if (!result.empty()) {
        const DualQuaternion moved = conjugate(before) * here;
        measured = measured * moved *
                   displacement(random.normal3(0.01 * rotation_angle(moved)),
                                random.normal3(0.01 * translation_length(moved)));
      }
      before = here;
      result.push_back({std::llround(t * 1e6), measured});
    }
    place += step * (rotation * Eigen::Vector3d(speed, 0, 0));
  }
  return result;
}

TEST(Selection, HeightIsNotPulledByStreamsInterpolatedAcrossFastTurns) {
  const DualQuaternion mount_a = displacement({0, 0, 0}, {1, 0, 1.8});
  const DualQuaternion mount_b = displacement({0.02, -0.03, 0.05}, {0, 0.4, 1.2});
  const DualQuaternion T = conjugate(mount_a) * mount_b;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Random random(seed);
    const Shaken car(random);
    const Trajectory a = odometry(car, mount_a, 10, 0, random), b = odometry(car, mount_b, 20, 0.035, random);
    const Calibration calibration = calibrate(a, b);
    const double error = calibration.T_a_b.translation.z() - to_pose(T).translation.z();
    printf("%d z %.3f sd %.3f stride %d %s\n", (int)seed, error, calibration.observability.stddev[2],
           calibration.choice.stride, calibration.choice.reason.c_str());
    if (!calibration.observability.observable[2]) continue;
    EXPECT_LT(std::abs(error), 4 * calibration.observability.stddev[2]) << seed;
  }
}

}  // namespace
}  // namespace egocal
