// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Hand-eye calibration from sets of still poses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <vector>

#include "../support/arm_samples.hpp"
#include "../support/paths.hpp"
#include "../support/real_drives.hpp"
#include "egocal/error.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "samples/agreeing.hpp"
#include "samples/sample_fit.hpp"

namespace egocal::test_samples {
namespace {

using testing::ArmSamples;
using testing::Random;
using testing::SimulatedSamples;

constexpr double degree = std::numbers::pi / 180;

SimulatedSamples arm(std::size_t samples, double rotation_noise, double position_noise, std::uint64_t seed,
                     std::size_t wrong = 0) {
  ArmSamples what;
  what.samples = samples;
  what.rotation_noise = rotation_noise;
  what.position_noise = position_noise;
  what.wrong = wrong;
  Random random(seed);
  return testing::simulate_arm(what, random);
}

ExtrinsicError error_of(const SimulatedSamples& drawn, const SampleCalibration& found) {
  return extrinsic_error(drawn.X, to_dual_quaternion(found.calibration.T_a_b));
}

std::vector<std::size_t> wrong_of(const SampleCalibration& found) {
  std::vector<std::size_t> wrong;
  for (std::size_t i = 0; i < found.residuals.size(); ++i)
    if (found.residuals[i].wrong) wrong.push_back(i);
  return wrong;
}

TEST(Samples, WithoutNoiseGiveBothPosesFromThreeOnAndHoweverManyThereAre) {
  for (const std::size_t n : {3u, 4u, 6u, 25u}) {
    const SimulatedSamples drawn = arm(n, 0, 0, n);
    const SampleCalibration found = calibrate_samples(drawn.samples);
    EXPECT_LT(error_of(drawn, found).rotation, 1e-9) << n;
    EXPECT_LT(error_of(drawn, found).translation, 1e-9) << n;
    const ExtrinsicError target = extrinsic_error(drawn.Y, to_dual_quaternion(found.T_world_a_world_b));
    EXPECT_LT(target.rotation, 1e-9) << n;
    EXPECT_LT(target.translation, 1e-9) << n;
    EXPECT_EQ(found.calibration.certificate.optimality, Optimality::certified) << n;
    EXPECT_LT(found.spread_largest, 1e-9) << n;
    EXPECT_TRUE(wrong_of(found).empty()) << n;
  }
}

TEST(Samples, SumsHoldTheCostAtEveryOrigin) {
  const SimulatedSamples drawn = arm(9, 1, 5, 21);
  const detail::SampleSet set(drawn.samples);
  detail::SampleSums sums;
  for (std::size_t i = 0; i < set.size(); ++i) sums.add(set.sums(i), set.sign(0, i));
  Random random(2);
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::Vector3d origin = random.normal3(1);
    const DualQuaternion X = to_dual_quaternion({rotation_exp(random.normal3(1)), random.normal3(0.3)});
    // the same from the poses of the target one by one
    std::vector<DualQuaternion> seen;
    Vector8d mean = Vector8d::Zero();
    Eigen::Vector3d where = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < set.size(); ++i) {
      const DualQuaternion y = set.seen(i).with(X);
      where += to_pose(y).translation / 9;
      const double sign = set.sign(0, i);
      const DualQuaternion from_origin = detail::shifted({sign * y.real, sign * y.dual}, -origin);
      seen.push_back(from_origin);
      mean += from_origin.vec() / 9;
    }
    double dual_squares = 0;
    for (const DualQuaternion& y : seen) dual_squares += (y.vec() - mean).tail<4>().squaredNorm();
    const Vector8d q = X.vec();
    EXPECT_NEAR(q.dot(sums.centred(origin).dual_rows * q), dual_squares, 1e-12 * (1 + dual_squares));
    EXPECT_LT((to_pose(sums.mean_target(X)).translation - where).norm(), 1e-12);
  }
}

TEST(Samples, DeviationsByOneStepAreThoseOfTheAnswersWithoutEachSample) {
  const SimulatedSamples drawn = arm(31, 0.3, 2, 22);
  SampleOptions options;
  options.diagnosis.enabled = false;
  const SampleCalibration found = calibrate_samples(drawn.samples, options);
  Eigen::Matrix<double, 6, 1> squares = Eigen::Matrix<double, 6, 1>::Zero();
  for (std::size_t k = 0; k < 31; ++k) {
    std::vector<PoseSample> rest = drawn.samples;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
    const Pose without = calibrate_samples(rest, options).calibration.T_a_b, &all = found.calibration.T_a_b;
    Eigen::Matrix<double, 6, 1> difference;
    difference << without.translation - all.translation,
        rotation_log(without.rotation * all.rotation.conjugate());
    squares += difference.cwiseAbs2();
  }
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(found.calibration.observability.stddev[static_cast<std::size_t>(i)] / std::sqrt(squares[i]),
                std::sqrt(29.0 / 31) * (1 + 1.21 / 29), 0.05)
        << i;
}

TEST(Samples, ManyWithoutWrongOnesNeedNoSearchAndManyWithWrongOnesStillHaveIt) {
  for (const std::size_t wrong : {0u, 1u, 24u}) {
    const SimulatedSamples drawn = arm(60, 0.3, 2, 23, wrong);
    const SampleCalibration found = calibrate_samples(drawn.samples);
    EXPECT_EQ(wrong_of(found).size(), wrong);
    EXPECT_LT(error_of(drawn, found).rotation, 0.3 * degree);
    EXPECT_LT(error_of(drawn, found).translation, 4e-3);
  }
}

TEST(Samples, AmongManyTheSameOnesAgreeAsOneByOne) {
  for (const std::size_t wrong : {0u, 40u, 150u}) {
    const SimulatedSamples drawn = arm(400, 0.3, 2, 24, wrong);
    const detail::SampleSet set(drawn.samples);
    detail::AgreeingOptions one_by_one;
    one_by_one.most_one_by_one = 400;
    const detail::AgreeingSamples slow = find_agreeing(set, {}, one_by_one), fast = find_agreeing(set, {});
    EXPECT_EQ(fast.chosen, slow.chosen);
    EXPECT_EQ(fast.chosen.size(), 400 - wrong);
    EXPECT_LT((fast.fit.X.vec() - slow.fit.X.vec()).norm(), 1e-9);
  }
}

/// Seconds of processor time, the least of three: other work on the machine only adds to it.
double seconds_for(const SimulatedSamples& drawn) {
  double least = 1e9;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const std::clock_t begin = std::clock();
    calibrate_samples(drawn.samples);
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

TEST(Samples, FourTimesAsManyTakeFourTimesAsLong) {
  const double few = seconds_for(arm(500, 0.3, 2, 25, 100)), many = seconds_for(arm(2000, 0.3, 2, 25, 400));
  EXPECT_LT(many, 10 * few) << few << " s, " << many << " s; their cube is 64 times as long";
}

TEST(Samples, TheOrderOfTheRowsChangesNoBit) {
  for (const std::size_t wrong : {0u, 2u}) {
    const SimulatedSamples drawn = arm(12, 0.3, 2, 5, wrong);
    const SampleCalibration found = calibrate_samples(drawn.samples);
    std::vector<std::size_t> order(drawn.samples.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    Random random(3);
    for (int shuffle = 0; shuffle < 5; ++shuffle) {
      for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
      std::vector<PoseSample> shuffled;
      for (const std::size_t i : order) {
        shuffled.push_back(drawn.samples[i]);
        if (i % 3 == 0) shuffled.back().a = -shuffled.back().a;  // q and -q are one pose
      }
      const SampleCalibration again = calibrate_samples(shuffled);
      EXPECT_EQ(again.calibration.T_a_b.translation, found.calibration.T_a_b.translation);
      EXPECT_EQ(again.calibration.T_a_b.rotation.coeffs(), found.calibration.T_a_b.rotation.coeffs());
      EXPECT_EQ(again.calibration.observability.stddev, found.calibration.observability.stddev);
      EXPECT_EQ(again.spread_rms, found.spread_rms);
      for (std::size_t i = 0; i < order.size(); ++i)
        EXPECT_EQ(again.residuals[i].wrong, found.residuals[order[i]].wrong);
    }
  }
}

TEST(Samples, TheUnitOfLengthChangesNothing) {
  const SimulatedSamples drawn = arm(10, 0.3, 2, 7);
  SampleOptions millimetres;
  millimetres.read_a.scale = millimetres.read_b.scale = 1000;
  const Pose m = calibrate_samples(drawn.samples).calibration.T_a_b;
  const Pose mm = calibrate_samples(drawn.samples, millimetres).calibration.T_a_b;
  EXPECT_LT(m.rotation.angularDistance(mm.rotation), 1e-9);
  EXPECT_LT((1000 * m.translation - mm.translation).norm(), 1e-6);
}

TEST(Samples, MotionsOfHalfATurnCount) {
  // a camera that is turned about its axis by half a turn between samples: the sign of these motions'
  // quaternions is decided by noise
  Random random(11);
  ArmSamples what;
  what.samples = 8;
  what.rotation_noise = 0.1;
  SimulatedSamples drawn = testing::simulate_arm(what, random);
  for (std::size_t i = 0; i < 4; ++i) {
    const Pose eye = to_pose(drawn.samples[i].b);
    const Pose turned =
        eye * testing::noisy({rotation_exp({0, 0, std::numbers::pi}), {0, 0, 0}}, 2e-3, 1e-3, random);
    drawn.samples.push_back(
        {drawn.Y * to_dual_quaternion(turned) * conjugate(drawn.X), to_dual_quaternion(turned)});
  }
  const SampleCalibration found = calibrate_samples(drawn.samples);
  EXPECT_TRUE(wrong_of(found).empty());
  EXPECT_LT(error_of(drawn, found).rotation, 0.15 * degree);
  EXPECT_LT(error_of(drawn, found).translation, 2e-3);
}

TEST(Samples, WrongOnesAreFoundFromSixOn) {
  for (const auto& [n, wrong] : {std::pair<std::size_t, std::size_t>{6, 1}, {10, 2}, {20, 4}, {50, 10}})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const SimulatedSamples drawn = arm(n, 0.3, 2, seed, wrong);
      const SampleCalibration found = calibrate_samples(drawn.samples);
      for (std::size_t i = 0; i < n; ++i)
        EXPECT_EQ(found.residuals[i].wrong, drawn.wrong[i]) << n << " " << seed;
      EXPECT_THAT(found.calibration.findings,
                  ::testing::Contains(::testing::Field(&Finding::code, "wrong_samples")));
      EXPECT_EQ(found.calibration.counts.outliers, wrong);
    }
}

TEST(Samples, AListInTheOtherConventionIsNamed) {
  const SimulatedSamples drawn = arm(10, 0.3, 2, 9);
  for (const Side side : {Side::a, Side::b}) {
    SampleOptions inverted;
    (side == Side::a ? inverted.read_a : inverted.read_b).invert = true;
    const SampleCalibration found = calibrate_samples(drawn.samples, inverted);
    EXPECT_EQ(found.calibration.verdict, Verdict::contradictory);
    // the motions cannot tell which list it is: both are named, one with the right answer
    ASSERT_GE(found.calibration.findings.size(), 2u);
    for (const std::string code : {"inverted_a", "inverted_b"}) {
      const auto named = std::find_if(found.calibration.findings.begin(), found.calibration.findings.end(),
                                      [&](const Finding& finding) { return finding.code == code; });
      ASSERT_NE(named, found.calibration.findings.end()) << code;
      EXPECT_FALSE(named->certain) << code;
      ASSERT_TRUE(named->T_a_b) << code;
      if (code.back() != (side == Side::a ? 'a' : 'b')) continue;
      const ExtrinsicError error = extrinsic_error(drawn.X, to_dual_quaternion(*named->T_a_b));
      EXPECT_LT(error.rotation, 0.5 * degree) << code;
      EXPECT_LT(error.translation, 0.005) << code;
    }
  }
  EXPECT_EQ(calibrate_samples(drawn.samples).calibration.verdict, Verdict::good);
}

TEST(Samples, FewInTheOtherConventionAreNotTakenForWrongSamples) {
  for (const double cone : {20.0, 45.0})
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
      for (const std::size_t n : {6u, 12u}) {
        ArmSamples what;
        what.samples = n;
        what.cone = cone;
        what.rotation_noise = 0.3;
        what.position_noise = 2;
        Random random(seed);
        const SimulatedSamples drawn = testing::simulate_arm(what, random);
        SampleOptions inverted;
        inverted.read_b.invert = true;
        const Calibration found = calibrate_samples(drawn.samples, inverted).calibration;
        EXPECT_EQ(found.verdict, Verdict::contradictory) << n << " " << cone << " " << seed << found.reason;
        EXPECT_THAT(found.findings, ::testing::Contains(::testing::Field(&Finding::code, "inverted_b")))
            << n << " " << cone << " " << seed;
      }
}

TEST(Samples, LengthsInMillimetresAreNamed) {
  const SimulatedSamples drawn = arm(10, 0.3, 2, 9);
  SampleOptions options;
  options.read_b.scale = 1000;
  const SampleCalibration found = calibrate_samples(drawn.samples, options);
  ASSERT_FALSE(found.calibration.findings.empty());
  EXPECT_EQ(found.calibration.findings.front().code, "units");
  EXPECT_NEAR(found.calibration.findings.front().value.value_or(0), 1e-3, 2e-5);
}

// The identity explains them without a residual, and would look like a perfect answer.
TEST(Samples, OfOneListGivenTwiceAreNamed) {
  for (const std::size_t n : {4u, 20u}) {
    std::vector<PoseSample> twice = arm(n, 0.3, 2, n).samples;
    for (PoseSample& sample : twice) sample.b = sample.a;
    const Calibration found = calibrate_samples(twice).calibration;
    EXPECT_EQ(found.verdict, Verdict::doubtful);
    ASSERT_EQ(found.findings.size(), 1u);
    EXPECT_EQ(found.findings.front().code, "same_stream");
    SampleOptions inverted;
    inverted.read_b.invert = true;
    const Calibration as_inverse = calibrate_samples(twice, inverted).calibration;
    EXPECT_EQ(as_inverse.verdict, Verdict::doubtful) << as_inverse.reason;
    EXPECT_THAT(as_inverse.findings, ::testing::ElementsAre(::testing::Field(&Finding::code, "same_stream")));
    twice.front().b = arm(1, 0, 0, 77).samples[0].a;  // a single other pose
    for (const Finding& finding : calibrate_samples(twice).calibration.findings)
      EXPECT_NE(finding.code, "same_stream");
  }
}

// A target that was printed to fit the page: the residuals are hardly larger than those of noise.
TEST(Samples, ATargetOfAnotherSizeIsNamed) {
  int named = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const SimulatedSamples drawn = arm(30, 0.3, 2, 500 + seed);
    SampleOptions options;
    EXPECT_THAT(calibrate_samples(drawn.samples, options).calibration.findings, ::testing::IsEmpty());
    options.read_b.scale = 1.04;
    const Calibration found = calibrate_samples(drawn.samples, options).calibration;
    if (found.findings.empty()) continue;
    ++named;
    EXPECT_EQ(found.findings.front().code, "scale");
    EXPECT_NEAR(found.findings.front().value.value_or(0), 1 / 1.04, 0.015);
    EXPECT_THAT(found.findings.front().remedy, ::testing::HasSubstr("--scale-b 0.9"));
  }
  EXPECT_GE(named, 38);
}

// The lengths of b are too long by what noise adds to them, which many samples show.
TEST(Samples, ThatAreNoisyAndManyHaveNoOtherScale) {
  for (std::uint64_t seed = 0; seed < 5; ++seed)
    EXPECT_THAT(calibrate_samples(arm(2000, 1, 30, 900 + seed).samples).calibration.findings,
                ::testing::IsEmpty());
}

TEST(Samples, WithoutEnoughOrWithoutNumbersAreRefused) {
  SimulatedSamples drawn = arm(2, 0, 0, 1);
  EXPECT_THROW(calibrate_samples(drawn.samples), Error);
  drawn = arm(5, 0, 0, 1);
  drawn.samples[2].b.dual[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(calibrate_samples(drawn.samples), Error);
}

TEST(Samples, ThatNeverMoveOrNeverTurnAreNotKnown) {
  const SimulatedSamples drawn = arm(8, 0, 0, 2);
  std::vector<PoseSample> still(8, drawn.samples[0]);
  EXPECT_NE(calibrate_samples(still).calibration.verdict, Verdict::good);
  std::vector<PoseSample> sliding;
  for (int i = 0; i < 8; ++i) {
    const DualQuaternion slide = testing::displacement({0, 0, 0}, {0.1 * i, 0.05 * i * i, 0.03 * (i % 3)});
    sliding.push_back(
        {slide * drawn.samples[0].a, conjugate(drawn.Y) * slide * drawn.samples[0].a * drawn.X});
  }
  const SampleCalibration found = calibrate_samples(sliding);
  for (int i = 0; i < 3; ++i)
    EXPECT_FALSE(found.calibration.observability.observable[static_cast<std::size_t>(i)]);
}

class RealSamples : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::have_real_drives()) GTEST_SKIP() << "no data in " << paths::data_dir();
  }
  static MatchedSamples read(const std::string& set) {
    return match_samples(testing::real_trajectory("hand_eye/" + set + "/hand.tum"),
                         testing::real_trajectory("hand_eye/" + set + "/eye.tum"));
  }
};

TEST_F(RealSamples, LookLikeSamplesAndStreamsDoNot) {
  const auto look = [](const std::string& a, const std::string& b) {
    return look_like_samples(testing::real_trajectory(a), testing::real_trajectory(b));
  };
  for (const std::string set : {"moveit50", "fsuarez6", "visp_to-hand", "aubo32", "scara"})
    EXPECT_TRUE(look("hand_eye/" + set + "/hand.tum", "hand_eye/" + set + "/eye.tum")) << set;
  for (const std::string run : {"run_14", "run_2", "run_8"})
    EXPECT_FALSE(look("tampere/mixture/" + run + "/a.tum", "tampere/mixture/" + run + "/b.tum")) << run;
}

TEST_F(RealSamples, OfMoveItAreWithinItsOwnTolerance) {
  const SampleCalibration found = calibrate_samples(read("moveit50").samples);
  const DualQuaternion accepted = to_dual_quaternion(
      {Rotation(0.255876863, -0.766238932, -0.560571464, 0.182111404).normalized(), {0.659, -0.249, 0.830}});
  const ExtrinsicError error = extrinsic_error(accepted, to_dual_quaternion(found.calibration.T_a_b));
  EXPECT_LT(error.rotation, 0.32 * degree);
  EXPECT_LT(error.translation, 1.1e-3);
  EXPECT_EQ(found.calibration.verdict, Verdict::good);
  EXPECT_TRUE(wrong_of(found).empty());
}

TEST_F(RealSamples, OfFsuarezHaveOneWrongPose) {
  const SampleCalibration found = calibrate_samples(read("fsuarez6").samples);
  EXPECT_THAT(wrong_of(found), ::testing::ElementsAre(4));
  EXPECT_LT(found.spread_median, 8.7e-3);
}

TEST_F(RealSamples, OfVispSpreadByTwoMillimetres) {
  const SampleCalibration found = calibrate_samples(read("visp_to-hand").samples);
  EXPECT_LT(found.spread_median, 2.2e-3);
  EXPECT_TRUE(wrong_of(found).empty());
}

TEST_F(RealSamples, OfAFourAxisArmDoNotShowTheHeight) {
  const SampleCalibration found = calibrate_samples(read("scara").samples);
  const std::array<bool, 6> expected{true, true, false, true, true, true};
  EXPECT_EQ(found.calibration.observability.observable, expected);
  EXPECT_NE(found.calibration.verdict, Verdict::good);
  EXPECT_LT(found.spread_median, 5e-3);
  EXPECT_TRUE(wrong_of(found).empty()) << "heavy tails belong to these detections";
}

TEST_F(RealSamples, OfAuboAreAllUsed) {
  const SampleCalibration found = calibrate_samples(read("aubo32").samples);
  EXPECT_LT(found.spread_median, 3.7e-3);
  EXPECT_TRUE(wrong_of(found).empty());
}

}  // namespace
}  // namespace egocal::test_samples
