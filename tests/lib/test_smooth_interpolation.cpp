// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A pose between two poses of a stream, from several on both sides, and what it does to the answer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "../support/random_motion.hpp"
#include "../support/shaken_car.hpp"
#include "diagnosis/motions/motions.hpp"
#include "egocal/calibrate.hpp"
#include "pairing/smooth_interpolation.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_smooth_interpolation {
namespace {

using detail::interpolate_smoothly;
using testing::displacement;

constexpr std::int64_t period_us = 100'000;
const Eigen::Vector3d none(0, 0, 0);

/// Eight poses of a path, the instant is between the fourth and the fifth.
template <typename Path>
Trajectory eight(const Path& path, double phase = 0, const std::vector<std::int64_t>& late_us = {}) {
  Trajectory poses;
  for (int i = 0; i < 8; ++i) {
    const std::int64_t time_us = i * period_us + (late_us.empty() ? 0 : late_us[static_cast<std::size_t>(i)]);
    poses.push_back({time_us, path(1e-6 * static_cast<double>(time_us) + phase)});
  }
  return poses;
}

double time_of(const Trajectory& poses, double part) {
  return 1e-6 * (static_cast<double>(poses[3].time_us) +
                 part * static_cast<double>(poses[4].time_us - poses[3].time_us));
}

double apart(const DualQuaternion& x, const DualQuaternion& y) {
  const DualQuaternion off = canonical_sign(normalized(conjugate(x) * y));
  return std::max(translation_length(off), rotation_angle(off));
}

TEST(SmoothInterpolation, ReproducesCubicPathsAtUnevenTimes) {
  const auto path = [](double t) {
    return displacement({0.3, -0.2, 0.5}, {1 + 2 * t - 3 * t * t + 4 * t * t * t, 8 * t, -t * t * t});
  };
  const Trajectory poses = eight(path, 0, {0, 20'000, -30'000, 10'000, 0, 25'000, -10'000, 40'000});
  for (const double part : {0.1, 0.5, 0.8}) {
    const auto pose = interpolate_smoothly(poses, part, {});
    ASSERT_TRUE(pose);
    EXPECT_LT(apart(*pose, path(time_of(poses, part))), 1e-9) << part;
  }
}

TEST(SmoothInterpolation, KeepsMotionOfThreeTenthsOfTheRate) {
  const auto path = [](double t) {
    const double shake = std::sin(2 * std::numbers::pi * 3 * t);
    return displacement({0, 0.03 * shake, 0.2 * t}, {8 * t, 0.5 * t * t, 0.05 * shake});
  };
  double smooth = 0, screw = 0;
  int count = 0;
  for (double phase = 0; phase < 1; phase += 0.037, ++count) {
    const Trajectory poses = eight(path, phase);
    const DualQuaternion right = path(time_of(poses, 0.5) + phase);
    const auto pose = interpolate_smoothly(poses, 0.5, {});
    ASSERT_TRUE(pose);
    smooth += std::pow(apart(*pose, right), 2);
    screw += std::pow(apart(interpolate(poses[3].pose, poses[4].pose, 0.5), right), 2);
  }
  smooth = std::sqrt(smooth / count);
  screw = std::sqrt(screw / count);
  std::printf("3 Hz at 10 Hz: off by %.2g of 0.035, along a screw %.2g\n", smooth, screw);
  EXPECT_LT(smooth, 0.02 * 0.035);
  EXPECT_GT(screw, 0.3 * 0.035);
}

TEST(SmoothInterpolation, DoesNotDependOnTheFrameOfTheOdometryNorOnSigns) {
  const auto path = [](double t) {
    return displacement({0.1 * std::sin(9 * t), 0, 0.5 * t}, {8 * t, std::sin(5 * t), 0});
  };
  const Trajectory poses = eight(path);
  Trajectory others = poses;
  const DualQuaternion world = displacement({1, -2, 0.5}, {300, -200, 40});
  for (std::size_t i = 0; i < others.size(); ++i) {
    others[i].pose = world * others[i].pose;
    if (i % 3 == 1) others[i].pose = -others[i].pose;
  }
  const auto pose = interpolate_smoothly(poses, 0.3, {}), other = interpolate_smoothly(others, 0.3, {});
  ASSERT_TRUE(pose && other);
  EXPECT_LT(apart(world * *pose, *other), 1e-9);
}

TEST(SmoothInterpolation, IsRefusedWhereThePathIsNotSmooth) {
  const auto path = [](double t) { return displacement({0, 0, 0.3 * t}, {8 * t, t * t, 0}); };
  const Trajectory right = eight(path);
  ASSERT_TRUE(interpolate_smoothly(right, 0.5, {}));
  const auto refused = [&](const char* what, const auto& change, double part = 0.5) {
    Trajectory poses = right;
    change(poses);
    EXPECT_FALSE(interpolate_smoothly(poses, part, {})) << what;
  };
  refused("spike", [](Trajectory& poses) { poses[5].pose = poses[5].pose * displacement(none, {0, 3, 0}); });
  refused("turned", [](Trajectory& poses) {
    poses[2].pose = poses[2].pose * displacement({0.5, 0, 0}, none);
  });
  refused("jump", [](Trajectory& poses) {
    for (std::size_t i = 4; i < 8; ++i) poses[i].pose = displacement(none, {0, 5, 0}) * poses[i].pose;
  });
  refused("repeated", [](Trajectory& poses) { poses[1].pose = poses[0].pose; });
  refused("pause", [](Trajectory& poses) {
    for (std::size_t i = 6; i < 8; ++i) poses[i].time_us += 4 * period_us;
  });
  refused("two poses at nearly one time", [](Trajectory& poses) {
    poses[6].time_us = poses[5].time_us + 1000;
    poses[6].pose = displacement({0, 0, 0.3e-6 * static_cast<double>(poses[6].time_us)}, none);
  });
  refused("the pose at the instant is missing", [](Trajectory& poses) {
    for (std::size_t i = 4; i < 8; ++i) {
      poses[i].time_us += period_us;
      poses[i].pose = displacement({0, 0, 0.3e-6 * static_cast<double>(poses[i].time_us)}, none);
    }
  });
  refused("stands, then moves", [](Trajectory& poses) {
    for (std::size_t i = 0; i < 5; ++i) poses[i].pose = poses[0].pose;
  });
}

/// Position, largest error in standard deviations.
struct Off {
  double metres = 0, deviations = 0;
};

Off calibrated(const testing::Streams& streams, std::size_t smooth_poses) {
  CalibrationOptions options;
  options.pairing.synchroniser.smooth_poses = smooth_poses;
  options.diagnosis.enabled = smooth_poses > 0;  // nothing is expected of the deviations along screws
  const Calibration found = calibrate(streams.a, streams.b, options);
  const auto error = detail::frame_a_difference(streams.T, to_dual_quaternion(found.T_a_b));
  Off off{error.head<3>().norm(), 0};
  for (int i = 0; i < 3; ++i)
    off.deviations = std::max(off.deviations,
                              std::abs(error[i]) / found.observability.stddev[static_cast<std::size_t>(i)]);
  return off;
}

// The diagnosis asks for the same poses again and again. In a part of them nothing is smooth.
TEST(SmoothInterpolation, WhatIsRememberedHasTheSameBits) {
  testing::Streams streams =
      testing::shaken_car({.rate_a = 10, .rate_b = 10, .phase_b = 0.03, .seconds = 20});
  streams.b[100].pose.dual *= 2;
  const detail::Instants plain = detail::synchronised(streams.a, streams.b, {}, 0.5),
                         remembering = plain.remembering();
  std::vector<bool> wrong(plain.size());
  wrong[3] = true;
  const detail::Instants fewer = remembering.without(wrong);
  detail::PoseReading inverted;
  inverted.invert = true;
  ASSERT_GT(plain.size(), 150u);
  const auto expect_same = [&](std::size_t i, const detail::PoseReading& reading) {
    const auto expect = [&](const detail::PosePair& found) {
      const detail::PosePair given = plain.at(i, reading, reading);
      EXPECT_EQ(found.a.vec(), given.a.vec()) << i;
      EXPECT_EQ(found.b.vec(), given.b.vec()) << i;
    };
    expect(remembering.at(i, reading, reading));
    if (i > 3) expect(fewer.at(i - 1, reading, reading));
  };
  for (int again = 0; again < 2; ++again)
    for (std::size_t i = 0; i < plain.size(); ++i) {
      expect_same(i, {});
      expect_same(i, inverted);
    }
}

// When both streams are cut alike they keep slow bends only. Before smooth interpolation the height of a car
// shaken at 1 to 6 Hz was wrong by up to 20 cm and ten standard deviations, with a verdict of `good`.
TEST(SmoothInterpolation, AShakenCarIsCalibratedWhateverTheRates) {
  double smooth = 0, cut = 0;
  int beyond = 0, drives = 0;
  for (const auto& [rate_a, rate_b] : {std::pair{10.0, 20.0}, std::pair{10.0, 10.0}, std::pair{20.0, 20.0}})
    for (const auto& [lowest, highest] : {std::pair{1.0, 3.0}, std::pair{2.0, 4.5}})
      for (std::uint64_t seed = 1; seed <= 2; ++seed, ++drives) {
        testing::ShakenCar car;
        car.rate_a = rate_a;
        car.rate_b = rate_b;
        car.lowest = lowest;
        car.highest = std::min(highest, 0.4 * rate_a);
        car.phase_b = 0.4 / rate_b;
        car.seed = seed;
        const testing::Streams streams = testing::shaken_car(car);
        const Off now = calibrated(streams, 8), before = calibrated(streams, 0);
        std::printf(
            "%g and %g Hz, shaken at %g to %g Hz: off by %.1f cm (%.1f), along screws %.1f cm (%.1f)\n",
            rate_a, rate_b, lowest, car.highest, 100 * now.metres, now.deviations, 100 * before.metres,
            before.deviations);
        smooth += now.metres * now.metres;
        cut += before.metres * before.metres;
        beyond += now.deviations > 4;
      }
  EXPECT_LT(smooth, 0.1 * cut);
  EXPECT_LT(std::sqrt(smooth / drives), 0.02);
  EXPECT_LE(beyond, 1);
}

}  // namespace
}  // namespace egocal::test_smooth_interpolation
