// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Circles on flat ground: the answer may be turned about their centre, and what that moves is not known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "../support/motions_of_a.hpp"
#include "../support/random_motion.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"

namespace egocal::test_hidden_turns {
namespace {

using testing::displacement;
using testing::problem_of;
using testing::Random;

using Flags = std::array<bool, 6>;

/// Round and round a circle of a's, on flat ground: the answer may be turned about its centre by any angle.
/// radius: zero for turns in place. offset: from a to b [m]; tilt: of a against the axis of turns [rad].
struct Circles {
  double radius, offset, tilt;
  Mode mode = Mode::spatial;
  bool has_prior = false;
};

std::string text_of(const Circles& circles) {
  return "radius " + std::to_string(circles.radius) + ", offset " + std::to_string(circles.offset) +
         ", tilt " + std::to_string(circles.tilt);
}

/// Counts directions that are called observable, and those of them that are off by more than `sigmas`.
struct Claims {
  int translations = 0, rotations = 0, missed = 0;
};

Claims claims_of_circles(const Circles& circles, double sigmas) {
  constexpr double noise = 0.01;
  Claims claims;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const bool in_plane = circles.mode == Mode::planar;
    Eigen::Vector3d direction = random.direction();
    if (in_plane) direction[2] = 0;
    const Eigen::Vector3d rotation =
        in_plane ? Eigen::Vector3d(0, 0, random.uniform(-3, 3)) : Eigen::Vector3d(random.direction());
    const DualQuaternion T = displacement(rotation, circles.offset * direction.normalized());
    const double heading = random.uniform(0, 6);
    const DualQuaternion tilted =
        displacement({circles.tilt * std::sin(heading), circles.tilt * std::cos(heading), 0}, {0, 0, 0});
    const double turn = circles.radius > 2 ? 0.8 / circles.radius : 0.1, length = turn * circles.radius;
    std::vector<MotionPair> pairs;
    for (int i = 0; i < 1000; ++i) {
      const DualQuaternion flat =
          displacement({0, 0, turn}, {length * std::cos(heading), length * std::sin(heading), 0});
      const DualQuaternion a = conjugate(tilted) * flat * tilted, b = conjugate(T) * a * T;
      const auto noisy = [&](const DualQuaternion& motion) {
        Eigen::Vector3d turned = random.normal3(noise * turn);
        Eigen::Vector3d shifted = random.normal3(noise * std::max(length, 0.01));
        if (in_plane) turned.head<2>().setZero(), shifted[2] = 0;
        return motion * displacement(turned, shifted);
      };
      const DualQuaternion noisy_a = noisy(a);
      pairs.push_back({noisy_a, noisy(b)});
    }
    Problem problem = problem_of(pairs);
    problem.mode = circles.mode;
    if (circles.has_prior) problem.prior = displacement(random.normal3(0.03), random.normal3(0.03)) * T;
    const Answer answer = solve(problem, Method::dual);
    const Flags& seen = answer.observability.observable;
    EXPECT_FALSE(seen[2] || seen[5]) << text_of(circles) << " " << seed;
    const Pose truth = to_pose(T), found = to_pose(answer.T_a_b);
    Eigen::Matrix<double, 6, 1> error;
    error << found.translation - truth.translation, rotation_log(found.rotation * truth.rotation.conjugate());
    for (std::size_t i = 0; i < 6; ++i) {
      if (!seen[i]) continue;
      ++(i < 3 ? claims.translations : claims.rotations);
      if (std::abs(error[static_cast<int>(i)]) > sigmas * answer.observability.stddev[i]) ++claims.missed;
    }
  }
  return claims;
}

TEST(HiddenTurns, NothingThatAHiddenTurnMovesIsCalledKnown) {
  for (const double radius : {0.0, 0.2, 1.0, 3.0, 10.0})
    for (const double offset : {0.5, 2.0})
      for (const double tilt : {0.0, 0.02, 0.04}) {
        const Circles circles{radius, offset, tilt};
        const Claims claims = claims_of_circles(circles, 3);
        EXPECT_EQ(claims.missed, 0) << text_of(circles);
        EXPECT_GE(claims.rotations, 30) << text_of(circles);  // of 40: roll and pitch are seen
        // only where b is by chance at the centre
        EXPECT_LE(claims.translations, 2) << text_of(circles);
      }
}

TEST(HiddenTurns, NothingThatAHiddenTurnMovesIsCalledKnownInThePlane) {
  for (const double radius : {0.0, 0.2, 1.0, 3.0, 10.0})
    for (const double offset : {0.5, 2.0}) {
      const Circles circles{radius, offset, 0, Mode::planar};
      const Claims claims = claims_of_circles(circles, 3);
      EXPECT_EQ(claims.missed, 0) << text_of(circles);
      EXPECT_LE(claims.translations, 2) << text_of(circles);
    }
}

/// A turn with a long arm is mostly translation in the coordinates of the answer, and is held at the nominal
/// value as a turn all the same.
TEST(HiddenTurns, ANominalValueHoldsTurnsWithLongArms) {
  for (const double radius : {0.0, 0.2, 1.0})
    for (const double tilt : {0.02, 0.04}) {
      const Circles circles{radius, 2, tilt, Mode::spatial, true};
      const Claims claims = claims_of_circles(circles, 3);
      EXPECT_EQ(claims.missed, 0) << text_of(circles);
      EXPECT_GE(claims.rotations, 30) << text_of(circles);
    }
}

/// b is so close to the centre that no turn moves it by much: its place is known, to what the turn moves it.
TEST(HiddenTurns, APlaceAtTheCentreOfTurnsIsKnown) {
  for (const bool has_prior : {false, true}) {
    const Circles circles{0, 0.01, 0, Mode::spatial, has_prior};
    const Claims claims = claims_of_circles(circles, 3);
    EXPECT_LE(claims.missed, 1);  // of 80: three sigmas are exceeded in 0.3 % by chance
    EXPECT_GE(claims.translations, 30);
    EXPECT_EQ(claims.rotations, 40);
  }
}

}  // namespace
}  // namespace egocal::test_hidden_turns
