// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Sets of still poses that look right and are not, or show less than they seem to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../support/arm_samples.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_samples_mistakes {
namespace {

using testing::ArmSamples;
using testing::Random;
using testing::SimulatedSamples;

constexpr double degree = std::numbers::pi / 180;

SimulatedSamples arm(std::size_t samples, std::uint64_t seed, double cone = 45) {
  ArmSamples what;
  what.samples = samples;
  what.cone = cone;
  what.rotation_noise = 0.2;
  what.position_noise = 2;
  what.robot_noise = 0.1;
  Random random(seed);
  return testing::simulate_arm(what, random);
}

/// The camera turns about one axis that does not tilt (about: up to that many radians), anywhere above the
/// target. noise: of the arm and the camera, as a multiple of 0.02 deg 0.3 mm and 0.2 deg 2 mm.
SimulatedSamples about_one_axis(std::size_t samples, double about, std::uint64_t seed, double noise = 1) {
  Random random(seed);
  SimulatedSamples result = arm(1, seed);
  result.samples.clear();
  const Pose X = to_pose(result.X), Y = to_pose(result.Y);
  const double first = random.uniform(-3, 3);
  for (std::size_t i = 0; i < samples; ++i) {
    const double turn = random.uniform(-about, about), x = random.uniform(-0.3, 0.3),
                 y = random.uniform(-0.3, 0.3), z = random.uniform(0.4, 0.8);
    const Rotation down(rotation_exp({std::numbers::pi, 0, 0}));
    const Pose eye{
        (Rotation(rotation_exp({0, 0, turn})) * down * Rotation(rotation_exp({0, 0, first}))).normalized(),
        {x, y, z}};
    const Pose hand = testing::noisy(Y * eye * inverse(X), noise * 0.02 * degree, noise * 3e-4, random);
    const Pose target = testing::noisy(inverse(eye), noise * 0.2 * degree, noise * 2e-3, random);
    result.samples.push_back({to_dual_quaternion(hand), to_dual_quaternion(inverse(target))});
  }
  return result;
}

/// The largest error of a direction that is said to be known, in its standard deviations.
double farthest(const SimulatedSamples& drawn, const Calibration& found) {
  const auto error = detail::frame_a_difference(drawn.X, to_dual_quaternion(found.T_a_b));
  double largest = 0;
  for (std::size_t i = 0; i < 6; ++i)
    if (found.observability.observable[i])
      largest =
          std::max(largest, std::abs(error[static_cast<Eigen::Index>(i)]) / found.observability.stddev[i]);
  return largest;
}

TEST(SampleMistakes, ManyAboutOneAxisAreKnownToWhatIsStated) {
  for (const std::size_t n : {20u, 40u, 80u})
    for (std::uint64_t seed = 1; seed <= 15; ++seed) {
      const SimulatedSamples drawn = about_one_axis(n, 1, seed);
      const Calibration found = calibrate_samples(drawn.samples).calibration;
      EXPECT_NE(found.verdict, Verdict::good) << n << " " << seed;
      EXPECT_LT(farthest(drawn, found), 5) << n << " " << seed;
    }
}

/// Noise put the camera kilometres away along the axis, and what that left of the positions was called their
/// noise, or a contradiction.
TEST(SampleMistakes, FewAboutOneAxisDoNotContradictEachOther) {
  for (const std::size_t n : {6u, 8u, 10u})
    for (const double noise : {1.0, 0.25, 0.01})
      for (std::uint64_t seed = 1; seed <= 15; ++seed) {
        const SimulatedSamples drawn = about_one_axis(n, std::numbers::pi, seed, noise);
        const SampleCalibration found = calibrate_samples(drawn.samples);
        EXPECT_EQ(found.calibration.verdict, Verdict::incomplete)
            << n << " " << noise << " " << seed << ": " << found.calibration.reason;
        EXPECT_LT(found.noise_translation, noise * 0.02) << n << " " << noise << " " << seed;
        EXPECT_LT(farthest(drawn, found.calibration), 5) << n << " " << noise << " " << seed;
      }
}

TEST(SampleMistakes, WithoutTurnsAreTooLittleMotionAndInAWrongOrderAContradiction) {
  for (const std::size_t n : {6u, 12u, 40u})
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const SimulatedSamples drawn = about_one_axis(n, 0, seed);
      const Calibration found = calibrate_samples(drawn.samples).calibration;
      EXPECT_EQ(found.verdict, Verdict::incomplete) << n << " " << seed << found.reason;
      EXPECT_THAT(found.findings,
                  ::testing::ElementsAre(::testing::Field(&Finding::code, "too_little_motion")));
      std::vector<PoseSample> mixed = drawn.samples;
      for (std::size_t i = 0; i < n; ++i) mixed[i].b = drawn.samples[(i + 2) % n].b;
      EXPECT_EQ(calibrate_samples(mixed).calibration.verdict, Verdict::contradictory) << n << " " << seed;
    }
}

/// From sample `at` on the camera, or the target, is elsewhere.
std::vector<PoseSample> slipped(const SimulatedSamples& drawn, std::size_t at, const Pose& by, bool target) {
  std::vector<PoseSample> samples = drawn.samples;
  const DualQuaternion change = to_dual_quaternion(by);
  for (std::size_t i = at; i < samples.size(); ++i)
    samples[i].b = target ? change * samples[i].b : samples[i].b * change;
  return samples;
}

const Finding* find(const Calibration& calibration, const std::string& code) {
  const auto found = std::find_if(calibration.findings.begin(), calibration.findings.end(),
                                  [&](const Finding& finding) { return finding.code == code; });
  return found == calibration.findings.end() ? nullptr : &*found;
}

TEST(SampleMistakes, AMountingThatSlipsIsNamedWithTheAnswerAfterIt) {
  for (const std::size_t n : {20u, 60u})
    for (const double part : {0.5, 0.75})
      for (const bool target : {false, true})
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
          const SimulatedSamples drawn = arm(n, seed);
          const auto at = static_cast<std::size_t>(part * static_cast<double>(n));
          const Pose by{rotation_exp({0, 3 * degree, 0}), {0.01, 0, 0}};
          const Calibration found = calibrate_samples(slipped(drawn, at, by, target)).calibration;
          EXPECT_GE(found.verdict, Verdict::doubtful) << n << " " << part << " " << target << " " << seed;
          const Finding* slip = find(found, "mount_moved");
          ASSERT_NE(slip, nullptr) << n << " " << part << " " << target << " " << seed;
          ASSERT_TRUE(slip->T_a_b);
          const Pose after = target ? to_pose(drawn.X) : to_pose(drawn.X) * by;
          EXPECT_LT(slip->T_a_b->rotation.angularDistance(after.rotation), degree);
          EXPECT_LT((slip->T_a_b->translation - after.translation).norm(), 0.01);
          EXPECT_THAT(slip->message, ::testing::HasSubstr(target ? "the target" : "the camera"));
        }
}

/// The answer of all samples is near neither place.
TEST(SampleMistakes, ALargeSlipIsNamedAndSamplesThatAgreeBadlyAreDoubtful) {
  for (const std::size_t n : {8u, 12u, 30u})
    for (const double size : {0.1, 0.2, 0.4})
      for (const bool target : {false, true})
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
          const SimulatedSamples drawn = arm(n, seed);
          const Pose by{rotation_exp({0, 0, size * 2}), {size, size / 2, 0}};
          const Calibration found = calibrate_samples(slipped(drawn, n / 2, by, target)).calibration;
          EXPECT_GE(found.verdict, Verdict::doubtful)
              << n << " " << size << " " << target << " " << seed << " " << found.reason;
          if (n < 12) continue;  // six poses and twelve numbers for each part
          const Finding* slip = find(found, "mount_moved");
          ASSERT_NE(slip, nullptr) << n << " " << size << " " << target << " " << seed;
          const Pose after = target ? to_pose(drawn.X) : to_pose(drawn.X) * by;
          // of six or fifteen poses
          EXPECT_LT(slip->T_a_b->rotation.angularDistance(after.rotation), n < 30 ? 2 * degree : degree);
          EXPECT_LT((slip->T_a_b->translation - after.translation).norm(), n < 30 ? 0.06 : 0.02);
        }
}

/// Those after it are the minority, and are rejected as wrong samples.
TEST(SampleMistakes, ALargeSlipThatLeavesAMinorityIsNamed) {
  for (const std::size_t n : {30u, 60u})
    for (const double part : {0.3, 0.65, 0.75})
      for (const bool target : {false, true})
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
          const SimulatedSamples drawn = arm(n, seed);
          const auto at = static_cast<std::size_t>(part * static_cast<double>(n));
          const Pose by{rotation_exp({0, 0, 0.4}), {0.2, 0.1, 0}};
          const Calibration found = calibrate_samples(slipped(drawn, at, by, target)).calibration;
          EXPECT_GE(found.verdict, Verdict::doubtful)
              << n << " " << part << " " << target << " " << seed << " " << found.reason;
          EXPECT_NE(find(found, "mount_moved"), nullptr) << n << " " << part << " " << target << " " << seed;
        }
}

TEST(SampleMistakes, ASlipOfACentimetreIsNamedAndTheAnswerDependsOnNoOrder) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SimulatedSamples drawn = arm(60, seed);
    const std::vector<PoseSample> samples = slipped(drawn, 30, {Rotation::Identity(), {0, 0.01, 0}}, false);
    const Calibration found = calibrate_samples(samples).calibration;
    EXPECT_NE(find(found, "mount_moved"), nullptr) << seed;
    EXPECT_GE(found.verdict, Verdict::doubtful) << seed;
    std::vector<PoseSample> others;
    for (std::size_t i = 0; i < 60; ++i) others.push_back(samples[i * 7 % 60]);
    const Calibration mixed = calibrate_samples(others).calibration;
    EXPECT_EQ(find(mixed, "mount_moved"), nullptr) << seed;
    EXPECT_EQ(mixed.T_a_b.translation, found.T_a_b.translation);
    EXPECT_EQ(mixed.observability.stddev, found.observability.stddev);
  }
}

// Errors that depend on the pose divide a scan, too.
TEST(SampleMistakes, AnArmWithErrorsOfItsOwnHasNotSlipped) {
  for (const std::size_t n : {12u, 30u, 100u})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      std::vector<PoseSample> samples = arm(n, seed).samples;
      std::sort(samples.begin(), samples.end(), [](const PoseSample& x, const PoseSample& y) {
        return to_pose(x.a).translation.x() < to_pose(y.a).translation.x();
      });
      for (PoseSample& sample : samples) {
        Pose a = to_pose(sample.a);
        const Eigen::Vector3d error = (4 * a.translation).array().sin();
        a.translation += 3e-3 * error;
        a.rotation = (a.rotation * Rotation(rotation_exp(0.3 * degree * error))).normalized();
        sample.a = to_dual_quaternion(a);
      }
      EXPECT_EQ(find(calibrate_samples(samples).calibration, "mount_moved"), nullptr) << n << " " << seed;
    }
}

TEST(SampleMistakes, BothListsInvertedAreNamedWithTheOtherAnswer) {
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SimulatedSamples drawn = arm(15, seed);
    if (to_pose(drawn.Y).translation.norm() < 0.4) continue;  // as far as a camera on the hand may be
    ++right;
    EXPECT_THAT(calibrate_samples(drawn.samples).calibration.findings, ::testing::IsEmpty()) << seed;
    SampleOptions inverted;
    inverted.read_a.invert = inverted.read_b.invert = true;  // by --eye-to-hand --invert-b
    std::vector<PoseSample> files = drawn.samples;           // or in the files
    for (PoseSample& sample : files) sample = {conjugate(sample.a), conjugate(sample.b)};
    for (const Calibration& found :
         {calibrate_samples(drawn.samples, inverted).calibration, calibrate_samples(files).calibration}) {
      const Finding* both = find(found, "inverted_both");
      ASSERT_NE(both, nullptr) << seed;
      EXPECT_FALSE(both->certain);
      EXPECT_LT(found.verdict, Verdict::doubtful);
      ASSERT_TRUE(both->T_a_b);
      EXPECT_LT(both->T_a_b->rotation.angularDistance(to_pose(drawn.X).rotation), degree) << seed;
    }
  }
  EXPECT_GT(right, 10);
}

/// y and what turns about x and z with the opposite sign; or x and y exchanged, quaternions too.
enum class LeftHanded { mirrored, exchanged };

DualQuaternion left_handed(const DualQuaternion& pose, LeftHanded how) {
  const Pose right = to_pose(pose);
  const Eigen::Vector3d t = right.translation;
  const Eigen::Quaterniond q = right.rotation;
  const Pose left = how == LeftHanded::mirrored ? Pose{{q.w(), -q.x(), q.y(), -q.z()}, {t.x(), -t.y(), t.z()}}
                                                : Pose{{q.w(), q.y(), q.x(), q.z()}, {t.y(), t.x(), t.z()}};
  return to_dual_quaternion(left);
}

/// The rotations agree as well as right ones, with an answer that is half a turn off.
TEST(SampleMistakes, AListInLeftHandedAxesIsNamed) {
  for (const LeftHanded how : {LeftHanded::mirrored, LeftHanded::exchanged})
    for (const bool of_b : {false, true})
      for (const std::size_t n : {8u, 20u})
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
          SimulatedSamples drawn = arm(n, seed);
          EXPECT_THAT(calibrate_samples(drawn.samples).calibration.findings,
                      ::testing::Not(::testing::Contains(::testing::Field(&Finding::code, "axes_b"))));
          for (PoseSample& sample : drawn.samples) {
            DualQuaternion& pose = of_b ? sample.b : sample.a;
            pose = left_handed(pose, how);
          }
          const Calibration found = calibrate_samples(drawn.samples).calibration;
          EXPECT_EQ(found.verdict, Verdict::contradictory) << n << " " << seed << " " << found.reason;
          EXPECT_NE(find(found, of_b ? "axes_b" : "axes_a"), nullptr) << n << " " << seed;
        }
}

/// Columns of the positions alone.
TEST(SampleMistakes, ExchangedColumnsOfPositionsAreNamed) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SimulatedSamples drawn = arm(15, seed);
    std::vector<PoseSample> samples = drawn.samples;
    for (PoseSample& sample : samples) {
      Pose pose = to_pose(sample.b);
      pose.translation = Eigen::Vector3d(pose.translation.y(), pose.translation.x(), -pose.translation.z());
      sample.b = to_dual_quaternion(pose);
    }
    const Calibration found = calibrate_samples(samples).calibration;
    EXPECT_EQ(found.verdict, Verdict::contradictory) << seed;
    const Finding* axes = find(found, "axes_b");
    ASSERT_NE(axes, nullptr) << seed;
    ASSERT_TRUE(axes->T_a_b);
    EXPECT_LT(axes->T_a_b->rotation.angularDistance(to_pose(drawn.X).rotation), degree) << seed;
  }
}

TEST(SampleMistakes, BothListsInMillimetresAreNamed) {
  for (const double unit : {1000.0, 100.0})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SampleOptions options;
      options.read_a.scale = options.read_b.scale = unit;
      const Calibration found = calibrate_samples(arm(15, seed).samples, options).calibration;
      const Finding* units = find(found, "units");
      ASSERT_NE(units, nullptr);
      EXPECT_EQ(units->certain, unit == 1000);
      EXPECT_GE(found.verdict, Verdict::doubtful);
      options.diagnosis.unit = LengthUnit::unknown;
      EXPECT_EQ(find(calibrate_samples(arm(15, seed).samples, options).calibration, "units"), nullptr);
    }
}

TEST(SampleMistakes, FewThatDoNotBelongTogetherClaimNothing) {
  int claimed = 0;
  for (const std::size_t n : {4u, 5u, 6u})
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      std::vector<PoseSample> samples = arm(n, seed).samples;
      EXPECT_LT(calibrate_samples(samples).calibration.verdict, Verdict::doubtful) << n << " " << seed;
      for (PoseSample& sample : samples) {
        const Pose b = to_pose(sample.b);
        sample.b = to_dual_quaternion({b.rotation.conjugate(), b.translation});
      }
      claimed += calibrate_samples(samples).calibration.verdict < Verdict::doubtful;
    }
  EXPECT_EQ(claimed, 0);
}

}  // namespace
}  // namespace egocal::test_samples_mistakes
