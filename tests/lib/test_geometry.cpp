// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>

#include "../support/random_motion.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::test_geometry {
namespace {

using testing::displacement;
using testing::Random;

/// Identity, nearly identity, random and half turns: one suite of properties over all of them.
std::vector<DualQuaternion> displacements() {
  Random random(1);
  std::vector<DualQuaternion> all = {DualQuaternion{}, displacement({0, 0, 0}, {1, 2, 3})};
  for (const double angle : {1e-12, 1e-8, 1e-4, 1.0, 3.0, std::numbers::pi - 1e-8, std::numbers::pi})
    for (int i = 0; i < 8; ++i) all.push_back(displacement(angle * random.direction(), random.normal3(10)));
  return all;
}

double difference(const DualQuaternion& p, const DualQuaternion& q) {
  return std::min((p.vec() - q.vec()).norm(), (p.vec() + q.vec()).norm());
}

TEST(DualQuaternion, ProductsAreMatrixProducts) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const DualQuaternion p{{random.normal(), random.normal(), random.normal(), random.normal()},
                           {random.normal(), random.normal(), random.normal(), random.normal()}};
    const DualQuaternion q{{random.normal(), random.normal(), random.normal(), random.normal()},
                           {random.normal(), random.normal(), random.normal(), random.normal()}};
    EXPECT_LT(((p * q).vec() - left_matrix(p) * q.vec()).norm(), 1e-13);   // (11)
    EXPECT_LT(((p * q).vec() - right_matrix(q) * p.vec()).norm(), 1e-13);  // (11)
  }
}

TEST(DualQuaternion, ComposeAsPosesDo) {
  for (const DualQuaternion& p : displacements())
    for (const DualQuaternion& q : displacements()) {
      const Pose product = to_pose(p) * to_pose(q);
      EXPECT_LT(difference(p * q, to_dual_quaternion(product)), 1e-13);
      const Eigen::Vector3d x(0.3, -2, 5);
      EXPECT_LT((product * x - to_pose(p) * (to_pose(q) * x)).norm(), 1e-12);
    }
}

TEST(DualQuaternion, TranslationIsOnTheLeftOfTheRotation) {
  // (7): q = r + eps 1/2 t r. With t on the right the translation would come out rotated.
  const DualQuaternion q = displacement({0, 0, std::numbers::pi / 2}, {1, 0, 0});
  EXPECT_LT((to_pose(q) * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 1, 0)).norm(), 1e-15);
  const Eigen::Vector4d expected = 0.5 * quaternion_product({0, 1, 0, 0}, q.real);
  EXPECT_LT((q.dual - expected).norm(), 1e-15);
}

TEST(DualQuaternion, ConjugateIsTheInverse) {
  for (const DualQuaternion& q : displacements()) {
    EXPECT_LT(difference(q * conjugate(q), {}), 1e-14);
    EXPECT_LT(difference(to_dual_quaternion(inverse(to_pose(q))), conjugate(q)), 1e-14);
  }
}

TEST(DualQuaternion, NormalisationIsIdempotentAndUnit) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const DualQuaternion q =
        normalized({{random.normal(), random.normal(), random.normal(), random.normal()},
                    {random.normal(), random.normal(), random.normal(), random.normal()}});
    EXPECT_NEAR(q.real.norm(), 1, 1e-15);
    EXPECT_NEAR(q.real.dot(q.dual), 0, 1e-15);
  }
}

TEST(DualQuaternion, SignIsCanonicalAlsoAtHalfTurns) {
  for (const DualQuaternion& q : displacements())
    EXPECT_EQ(canonical_sign(q).vec(), canonical_sign(-q).vec());
}

TEST(Interpolation, EndsAndHalvesAreExact) {
  for (const DualQuaternion& p : displacements())
    for (const DualQuaternion& q : displacements()) {
      EXPECT_LT(difference(interpolate(p, q, 0), p), 1e-15);
      EXPECT_LT(difference(interpolate(p, q, 1), q), 1e-15);
      // two half motions make the whole (a half turn has two of them)
      const DualQuaternion half = conjugate(p) * interpolate(p, q, 0.5);
      EXPECT_LT(difference(half * half, conjugate(p) * q), 1e-7);
    }
}

TEST(Interpolation, FollowsTheScrew) {
  const DualQuaternion q = displacement({0, 0, 1}, {0, 0, 2});
  const Pose third = to_pose(interpolate({}, q, 1.0 / 3));
  EXPECT_LT((rotation_log(third.rotation) - Eigen::Vector3d(0, 0, 1.0 / 3)).norm(), 1e-15);
  EXPECT_LT((third.translation - Eigen::Vector3d(0, 0, 2.0 / 3)).norm(), 1e-15);
}

TEST(Screw, AngleAndSlideDoNotDependOnTheSensor) {
  Random random(4);
  for (const DualQuaternion& motion : displacements()) {
    const DualQuaternion T = testing::normal_displacement(random, 1, 5);
    const Screw a = screw_of(T * motion * conjugate(T)), b = screw_of(motion);
    EXPECT_NEAR(a.angle, b.angle, 1e-7);
    if (b.angle > 1e-3 && b.angle < 3.1) {
      EXPECT_NEAR(a.slide, b.slide, 1e-9);
    }
  }
}

/// Also at and near a pitch of a quarter turn, where an exported extrinsic is read back from these angles.
TEST(RollPitchYaw, MakeTheRotation) {
  const double quarter = std::numbers::pi / 2;
  for (const double roll : {-3.0, -0.7, 0.0, 0.2, 3.1})
    for (const double pitch : {0.0, 0.3, -1.2, quarter, -quarter, quarter - 1e-9, 1e-12 - quarter})
      for (const double yaw : {-3.1, -0.3, 0.0, 0.4, 2.0}) {
        const auto rotation = [](const Eigen::Vector3d& angles) {
          return Rotation(Eigen::AngleAxisd(angles[2], Eigen::Vector3d::UnitZ()) *
                          Eigen::AngleAxisd(angles[1], Eigen::Vector3d::UnitY()) *
                          Eigen::AngleAxisd(angles[0], Eigen::Vector3d::UnitX()));
        };
        const Rotation R = rotation({roll, pitch, yaw});
        EXPECT_LT(R.angularDistance(rotation(roll_pitch_yaw(R))), 4e-8) << roll << " " << pitch << " " << yaw;
      }
}

TEST(Errors, AreThoseOf32) {
  const DualQuaternion truth = displacement({0.3, -1, 2}, {4, 5, 6});
  const DualQuaternion estimate = truth * displacement({0, 0.01, 0}, {0.03, 0, 0.04});
  const ExtrinsicError error = extrinsic_error(truth, estimate);
  EXPECT_NEAR(error.rotation, 0.01, 1e-14);
  EXPECT_NEAR(error.translation, 0.05, 1e-14);
  EXPECT_NEAR(extrinsic_error(truth, -truth).rotation, 0, 1e-14);
  EXPECT_NEAR(extrinsic_error(truth, truth * displacement({0, 0, 1e-9}, {0, 0, 0})).rotation, 1e-9, 1e-15);
}

TEST(GroundPlane, FrameStandsOnTheGroundWithZUp) {
  const GroundPlane plane = validated({Eigen::Vector3d(-0.0066, -0.9998, -0.0177).normalized(), -1.685});
  const Pose G = to_pose(plane_frame(plane));
  EXPECT_LT((G.rotation * Eigen::Vector3d::UnitZ() - plane.normal).norm(), 1e-15);
  // the origin of the plane's frame lies on the plane, right below the sensor
  EXPECT_NEAR(plane.normal.dot(G.translation), plane.distance, 1e-15);
  EXPECT_NEAR(G.translation.norm(), 1.685, 1e-15);
}

TEST(GroundPlane, MotionOnTheGroundIsPlanarAndTComesBack) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const DualQuaternion G_a = plane_frame({random.direction(), -random.uniform(0.1, 3)});
    const DualQuaternion G_b = plane_frame({random.direction(), -random.uniform(0.1, 3)});
    const DualQuaternion T_p =
        displacement({0, 0, random.uniform(-3, 3)}, {random.normal(), random.normal(), 0});
    const DualQuaternion T = extrinsic_from_planar(T_p, G_a, G_b);  // (27)
    EXPECT_LT(difference(planar_from_extrinsic(T, G_a, G_b), T_p), 1e-14);
    // a motion of the vehicle, seen from a, from b, and from both planes
    const DualQuaternion V_p = displacement({0, 0, 0.1}, {1, 0.2, 0});
    const DualQuaternion V_a = G_a * V_p * conjugate(G_a);
    const DualQuaternion V_b = conjugate(T) * V_a * T;
    EXPECT_LT(difference(planar_motion(V_a, G_a), V_p), 1e-14);  // (24a)
    EXPECT_LT(difference(planar_motion(V_b, G_b), conjugate(T_p) * V_p * T_p), 1e-14);
  }
}

}  // namespace
}  // namespace egocal::test_geometry
