// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>

#include "../support/motions_of_a.hpp"
#include "../support/random_motion.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/problem/blocks.hpp"

namespace egocal::test_observability {
namespace {

using testing::displacement;
using testing::motions_of_a;
using testing::planar_motion_of_a;
using testing::problem_of;
using testing::Random;
using testing::random_pairs;
using testing::T_a_b;

using Flags = std::array<bool, 6>;

TEST(Observability, FreeMotionShowsEverything) {
  Random random(1);
  const Answer answer =
      solve(problem_of(random_pairs(T_a_b, {.pairs = 300, .noise = 0.01}, random)), Method::dual);
  EXPECT_EQ(answer.observability.observable, (Flags{true, true, true, true, true, true}));
  for (const double stddev : answer.observability.stddev) {
    EXPECT_GT(stddev, 0);
    EXPECT_LT(stddev, 0.1);
  }
  EXPECT_EQ(answer.observability.hint, "");
}

TEST(Observability, HeightIsNeverSeenInPlanarMotion) {
  for (const double noise : {0.0, 1e-9, 1e-6, 1e-3, 0.01, 0.05, 0.1})
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Answer answer =
          solve(problem_of(motions_of_a(T_a_b, 300, noise, seed, planar_motion_of_a)), Method::dual);
      const Flags& seen = answer.observability.observable;
      EXPECT_FALSE(seen[2]) << noise << " " << seed;
      EXPECT_TRUE(std::isinf(answer.observability.stddev[2]));
      if (noise <= 0.01) {
        EXPECT_EQ(seen, (Flags{true, true, false, true, true, true})) << noise << " " << seed;
      }
      EXPECT_NE(answer.observability.hint, "");
      EXPECT_EQ(answer.certificate.optimality, Optimality::certified);
    }
}

TEST(Observability, PureTranslationShowsNoTranslation) {
  for (const double noise : {0.0, 0.01}) {
    const Answer answer = solve(problem_of(motions_of_a(T_a_b, 200, noise, 1,
                                                        [](Random& random) {
                                                          return displacement({0, 0, 0}, random.normal3());
                                                        })),
                                Method::dual);
    EXPECT_EQ(answer.observability.observable, (Flags{false, false, false, true, true, true})) << noise;
    EXPECT_EQ(answer.observability.hint, "still needed: turns");
    EXPECT_LT(extrinsic_error(T_a_b, answer.T_a_b).rotation, 0.01);
  }
}

TEST(Observability, StraightOnShowsOnlyTheDirection) {
  const Answer answer =
      solve(problem_of(motions_of_a(T_a_b, 200, 0, 1,
                                    [](Random& random) {
                                      return displacement({0, 0, 0}, {random.uniform(0.5, 1.5), 0, 0});
                                    })),
            Method::dual);
  // roll turns about the direction of travel
  EXPECT_EQ(answer.observability.observable, (Flags{false, false, false, false, true, true}));
}

TEST(Observability, NoMotionShowsNothing) {
  Problem problem = problem_of(std::vector<MotionPair>(50));
  problem.prior = T_a_b;
  for (const Method method : {Method::dual, Method::sdp, Method::sqp, Method::slsqp}) {
    const Answer answer = solve(problem, method);
    EXPECT_EQ(answer.observability.observable, Flags{}) << to_string(method);
    EXPECT_LT(extrinsic_error(T_a_b, answer.T_a_b).translation, 1e-12);
    EXPECT_LT(extrinsic_error(T_a_b, answer.T_a_b).rotation, 1e-12);
    EXPECT_NE(answer.observability.hint, "");
  }
  EXPECT_EQ(solve(Problem{}, Method::dual).observability.observable, Flags{});
}

TEST(Observability, OnePairShowsNoTranslationAlongItsAxis) {
  const Answer answer = solve(problem_of(motions_of_a(T_a_b, 1, 0, 1, planar_motion_of_a)), Method::dual);
  EXPECT_FALSE(answer.observability.observable[2]);
  EXPECT_TRUE(answer.T_a_b.vec().allFinite());
}

TEST(Observability, FlatDirectionsAreTakenFromThePrior) {
  // true except for the height: the motions give x, y and the rotation, the prior gives z
  Problem problem = problem_of(motions_of_a(T_a_b, 100, 0, 1, planar_motion_of_a));
  Pose prior = to_pose(T_a_b);
  prior.translation += Eigen::Vector3d(0.3, -0.2, 0.7);
  prior.rotation = prior.rotation * rotation_exp({0.05, 0.02, -0.03});
  problem.prior = to_dual_quaternion(prior);
  for (const Method method : {Method::dual, Method::sdp, Method::sqp}) {
    const Answer answer = solve(problem, method, problem.prior);
    const Pose T = to_pose(answer.T_a_b), truth = to_pose(T_a_b);
    EXPECT_NEAR(T.translation.x(), truth.translation.x(), 1e-9) << to_string(method);
    EXPECT_NEAR(T.translation.y(), truth.translation.y(), 1e-9);
    EXPECT_NEAR(T.translation.z(), prior.translation.z(), 1e-6);
    EXPECT_LT(extrinsic_error(T_a_b, answer.T_a_b).rotation, 1e-9);
    EXPECT_EQ(answer.certificate.optimality, Optimality::certified);
    EXPECT_TRUE(std::isinf(answer.certificate.reach_translation));
  }
}

/// Of a noisy drive, whose cost has a minimum in every direction, with a prior that is off in all of them.
Problem noisy_problem_with_prior(const std::vector<MotionPair>& pairs) {
  Problem problem = problem_of(pairs);
  Pose prior = to_pose(T_a_b);
  prior.translation += Eigen::Vector3d(0.03, -0.02, 0.7);
  prior.rotation = rotation_exp({0.25, 0.02, -0.03}) * prior.rotation;
  problem.prior = to_dual_quaternion(prior);
  return problem;
}

TEST(Observability, NoiseAloneDoesNotReplaceThePrior) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Problem problem = noisy_problem_with_prior(motions_of_a(T_a_b, 300, 0.01, seed, planar_motion_of_a));
    const Pose prior = to_pose(*problem.prior);
    Problem without = problem;
    without.prior.reset();
    const Answer minimum = solve(without, Method::dual);
    EXPECT_GT(std::abs(to_pose(minimum.T_a_b).translation.z() - prior.translation.z()), 0.1) << seed;
    for (const Method method : {Method::dual, Method::sdp, Method::sqp, Method::slsqp}) {
      const Answer answer = solve(problem, method);
      const Pose T = to_pose(answer.T_a_b);
      EXPECT_EQ(answer.certificate.optimality, Optimality::certified) << to_string(method) << " " << seed;
      EXPECT_EQ(answer.observability.observable, (Flags{true, true, false, true, true, true}));
      // the axis that hides is known to a degree
      EXPECT_NEAR(T.translation.z(), prior.translation.z(), 0.02) << to_string(method) << " " << seed;
      for (const int i : {0, 1})
        EXPECT_LT(std::abs(T.translation[i] - to_pose(T_a_b).translation[i]),
                  4 * answer.observability.stddev[static_cast<std::size_t>(i)])
            << to_string(method) << " " << seed;
      EXPECT_LT(extrinsic_error(T_a_b, answer.T_a_b).rotation, 0.02) << to_string(method) << " " << seed;
      EXPECT_LT(extrinsic_error(minimum.T_a_b, answer.minimum).translation, 1e-6);
    }
  }
}

TEST(Observability, RollOfAStraightDriveIsTakenFromThePrior) {
  const auto straight = [](Random& random) {
    return displacement({0, 0, 0}, {random.uniform(0.5, 1.5), 0, 0});
  };
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Problem problem = noisy_problem_with_prior(motions_of_a(T_a_b, 300, 0.003, seed, straight));
    const Answer answer = solve(problem, Method::dual);
    const Pose T = to_pose(answer.T_a_b), prior = to_pose(*problem.prior), truth = to_pose(T_a_b);
    EXPECT_EQ(answer.certificate.optimality, Optimality::certified) << seed;
    EXPECT_EQ(answer.observability.observable, (Flags{false, false, false, false, true, true})) << seed;
    EXPECT_LT((T.translation - prior.translation).norm(), 1e-3) << seed;
    EXPECT_NEAR(rotation_log(T.rotation * truth.rotation.conjugate()).x(), 0.25, 0.02) << seed;
    EXPECT_LT(rotation_log(T.rotation * truth.rotation.conjugate()).tail<2>().norm(), 0.01) << seed;
  }
}

TEST(Observability, TurningInPlaceTakesHeightAndHeadingFromThePrior) {
  const Eigen::Vector3d centre(1.2, -0.4, 0);
  const auto swing = [&](Random& random) {
    const Eigen::Vector3d turn(0, 0, random.uniform(0.1, 0.3) * (random.normal() > 0 ? 1 : -1));
    return displacement(turn, centre - rotation_exp(turn) * centre);
  };
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Problem problem = noisy_problem_with_prior(motions_of_a(T_a_b, 300, 0.001, seed, swing));
    const Answer answer = solve(problem, Method::dual);
    const Pose prior = to_pose(*problem.prior), T = to_pose(answer.T_a_b);
    EXPECT_EQ(answer.certificate.optimality, Optimality::certified) << seed;
    EXPECT_FALSE(answer.observability.observable[2]) << seed;
    EXPECT_FALSE(answer.observability.observable[5]) << seed;
    EXPECT_NEAR(T.translation.z(), prior.translation.z(), 0.01) << seed;
    // the heading is the prior's, the place is where b then has the distance to the centre that it shows
    EXPECT_NEAR(rotation_log(prior.rotation * T.rotation.conjugate()).z(), 0, 0.01) << seed;
    const auto radius = [&](const Pose& pose) { return (pose.translation - centre).head<2>().norm(); };
    EXPECT_NEAR(radius(T), radius(to_pose(T_a_b)), 0.02) << seed;
  }
}

TEST(Observability, NoiseOfARigThatStandsLeavesThePrior) {
  const auto stands = [](Random&) { return displacement({0, 0, 0}, {0, 0, 0}); };
  int all_hidden = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Problem problem = noisy_problem_with_prior(motions_of_a(T_a_b, 300, 0.01, seed, stands));
    const Answer answer = solve(problem, Method::dual);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(answer.observability.observable[i]) << seed;
    if (answer.observability.observable != Flags{}) continue;
    ++all_hidden;
    EXPECT_LT(extrinsic_error(*problem.prior, answer.T_a_b).rotation, 1e-3) << seed;
    EXPECT_LT(extrinsic_error(*problem.prior, answer.T_a_b).translation, 1e-3) << seed;
  }
  EXPECT_GT(all_hidden, 10);
}

TEST(Observability, HiddenHeightCountsWhereATiltedSensorSeesIt) {
  // On flat ground a sensor that is tilted about y by an angle sees a part of the hidden height in x.
  for (const double tilt : {0.0, 0.01, 0.02, 0.04}) {
    int inside = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const DualQuaternion tilted = displacement({0, tilt, 0}, {0, 0, 0});
      const DualQuaternion T = conjugate(tilted) * T_a_b;
      const std::vector<MotionPair> pairs = motions_of_a(T, 300, 0.003, seed, [&](Random& random) {
        return conjugate(tilted) * planar_motion_of_a(random) * tilted;
      });
      const Answer answer = solve(problem_of(pairs), Method::dual);
      ASSERT_TRUE(answer.observability.observable[0]) << tilt << " " << seed;
      const Eigen::Vector3d found = to_pose(answer.T_a_b).translation;
      const double error = found.x() - to_pose(T).translation.x();
      if (std::abs(error) < 2 * answer.observability.stddev[0]) ++inside;
      // a metre, and what the answer claims, along the hidden axis
      EXPECT_LT(answer.observability.stddev[0], 0.03 + 1.5 * tilt * (1 + std::abs(found.z())))
          << tilt << " " << seed;
    }
    EXPECT_GE(inside, 36) << tilt;
  }
}

TEST(Observability, PlanarModeShowsXYAndYaw) {
  const GroundPlane plane_a{Eigen::Vector3d::UnitZ(), -1.8}, plane_b{Eigen::Vector3d(0, -1, 0), -1.6};
  const DualQuaternion G_a = plane_frame(plane_a), G_b = plane_frame(plane_b);
  const DualQuaternion T = extrinsic_from_planar(displacement({0, 0, 0.4}, {1, 2, 0}), G_a, G_b);
  std::vector<MotionPair> pairs = motions_of_a(T, 300, 0.01, 1, planar_motion_of_a);
  for (MotionPair& pair : pairs) pair = {planar_motion(pair.a, G_a), planar_motion(pair.b, G_b)};
  Problem problem = problem_of(pairs);
  problem.mode = Mode::planar;
  problem.plane_a = plane_a;
  problem.plane_b = plane_b;
  for (const Method method : {Method::dual, Method::sdp, Method::sqp, Method::slsqp}) {
    const Answer answer = solve(problem, method);
    EXPECT_EQ(answer.certificate.optimality, Optimality::certified) << to_string(method);
    EXPECT_EQ(answer.observability.observable, (Flags{true, true, false, false, false, true}));
    EXPECT_LT(extrinsic_error(T, answer.T_a_b).translation, 0.1);
    EXPECT_LT(extrinsic_error(T, answer.T_a_b).rotation, 0.01);
  }
}

TEST(Observability, PlanarModeWithoutTurnsShowsNoTranslation) {
  const GroundPlane plane{Eigen::Vector3d::UnitZ(), -1.8};
  Problem problem = problem_of(motions_of_a(displacement({0, 0, 0.4}, {1, 2, 0}), 100, 0, 1, [](Random&) {
    return displacement({0, 0, 0}, {1, 0, 0});
  }));
  problem.mode = Mode::planar;
  problem.plane_a = problem.plane_b = plane;
  const Answer answer = solve(problem, Method::dual);
  EXPECT_EQ(answer.observability.observable, (Flags{false, false, false, false, false, true}));
  EXPECT_EQ(answer.observability.hint, "still needed: turns");
}

TEST(Observability, IntervalsOfTwoSigmaCoverTheTruth) {
  // independent noise, free motion: each direction's 95 % interval must cover the truth in about 95 % of the
  // drives
  int covered = 0, cases = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const DualQuaternion T = testing::random_extrinsic(random);
    const Answer answer =
        solve(problem_of(random_pairs(T, {.pairs = 320, .noise = 0.01}, random)), Method::dual);
    const Pose truth = to_pose(T), estimate = to_pose(answer.T_a_b);
    Eigen::Matrix<double, 6, 1> error;
    error << estimate.translation - truth.translation,
        rotation_log(estimate.rotation * truth.rotation.conjugate());
    for (std::size_t i = 0; i < 6; ++i) {
      ASSERT_TRUE(answer.observability.observable[i]);
      ++cases;
      if (std::abs(error[static_cast<int>(i)]) <= 1.96 * answer.observability.stddev[i]) ++covered;
    }
  }
  const double share = static_cast<double>(covered) / cases;
  EXPECT_GT(share, 0.92);
  EXPECT_LT(share, 0.98);
}

/// Drives of 100 motions with rotation noise of which the sensors share a part (one gyro): common_part is the
/// correlation. tilt: of the ground [rad].
Answer with_shared_noise(double common_part, double tilt, std::uint64_t seed) {
  Random random(seed);
  const double sigma = 2e-3;  // [rad]
  std::vector<MotionPair> pairs;
  for (int i = 0; i < 100; ++i) {
    const double yaw = 0.2 * random.normal();
    const Eigen::Vector3d ramp = random.normal3(tilt);
    const DualQuaternion a = displacement({ramp.x(), ramp.y(), yaw}, {1 + 0.1 * random.normal(), 0, 0});
    const DualQuaternion b = conjugate(T_a_b) * a * T_a_b;
    const Eigen::Vector3d common = random.normal3(sigma * std::sqrt(common_part));
    const auto measured = [&](const DualQuaternion& motion, const Eigen::Vector3d& shared) {
      const Eigen::Vector3d own = random.normal3(sigma * std::sqrt(1 - common_part));
      const Eigen::Vector3d shift = random.normal3(0.01);
      return motion * displacement(shared + own, shift);
    };
    const DualQuaternion a_measured = measured(a, common);
    const DualQuaternion b_measured = measured(b, to_pose(T_a_b).rotation.conjugate() * common);
    pairs.push_back({a_measured, b_measured});
  }
  Problem problem = problem_of(pairs);
  problem.balance = {1, 0.01};
  return solve(problem, Method::dual);
}

/// Rotations cannot tell noise that the sensors share from tilt, translations can.
TEST(Observability, SharedRotationNoiseOnFlatGroundShowsNoHeight) {
  for (const double common_part : {0.0, 0.6, 0.9}) {
    int called_observable = 0, level_lost = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
      const Answer answer = with_shared_noise(common_part, 0, seed);
      called_observable += answer.observability.observable[2];
      level_lost += !answer.observability.observable[0] || !answer.observability.observable[1];
    }
    EXPECT_LE(called_observable, 1) << common_part;
    EXPECT_EQ(level_lost, 0) << common_part;
  }
}

TEST(Observability, SharedRotationNoiseOnRampsKeepsTheHeight) {
  for (const double common_part : {0.0, 0.6, 0.9}) {
    int called_observable = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed)
      called_observable += with_shared_noise(common_part, 0.03, seed).observability.observable[2];
    EXPECT_EQ(called_observable, 100) << common_part;
  }
}

/// On a motorway, in units of the long motions, a height that noise hides has the curvature of the roll now
/// and then: their eigenvectors were mixed, and the roll was hidden with the height.
TEST(Observability, AHeightThatNoiseHidesTakesNoRotationWithIt) {
  int hidden_heights = 0, rotations_lost = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    std::vector<MotionPair> pairs;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d suspension = random.normal3(4e-3);  // [rad]
      const Eigen::Vector3d turn = suspension + 0.1 * random.normal() * Eigen::Vector3d::UnitZ();
      const DualQuaternion a = displacement(turn, {50 * (1 + 0.1 * random.normal()), 0, 0});
      const DualQuaternion b = conjugate(T_a_b) * a * T_a_b;
      const auto measured = [&](const DualQuaternion& motion) {
        const Eigen::Vector3d rotation = random.normal3(2e-3), shift = random.normal3(0.01);
        return motion * displacement(rotation, shift);
      };
      const DualQuaternion a_measured = measured(a);
      pairs.push_back({a_measured, measured(b)});
    }
    Problem problem = problem_of(pairs);
    problem.balance = {1, 0.01};
    const Flags observable = solve(problem, Method::dual).observability.observable;
    hidden_heights += !observable[2];
    rotations_lost += !observable[3] || !observable[4] || !observable[5];
  }
  EXPECT_LE(rotations_lost, 2);  // 10 where they were mixed
  EXPECT_GT(hidden_heights, 80);
}

}  // namespace
}  // namespace egocal::test_observability
