// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Whether an answer can be used.
#include <gtest/gtest.h>

#include "../support/mistakes.hpp"
#include "../support/paths.hpp"
#include "../support/real_drives.hpp"
#include "diagnosis/verdict/judge.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_verdict {
namespace {

testing::Streams drive(Terrain terrain, double noise, int poses, std::uint64_t seed = 1) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = poses;
  options.relative_noise = noise;
  options.seed = seed;
  return testing::simulated_drive(options);
}

TEST(Verdict, IsGoodWhereAllIsKnown) {
  const testing::Streams streams = drive(Terrain::free, 0.01, 601);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::good) << calibration.reason;
  EXPECT_FALSE(calibration.reason.empty());
}

TEST(Verdict, IsIncompleteOnFlatGround) {
  const testing::Streams streams = drive(Terrain::flat, 0.01, 601);
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::incomplete) << calibration.reason;
}

TEST(Verdict, IsIncompleteAfterAFewSeconds) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const testing::Streams streams = drive(Terrain::rough, 0.01, 51, seed);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(calibration.verdict, Verdict::incomplete) << calibration.reason;
    // the limits are of all directions together: "not known to 1 deg" stood above 0.6 and 0.9 deg
    EXPECT_NE(calibration.reason.find(" (all directions together, 95 %: "), std::string::npos)
        << calibration.reason;
  }
}

TEST(Verdict, OfMotionPairsThatDoNotBelongTogether) {
  testing::Random random(5);
  std::vector<MotionPair> pairs;
  for (int i = 0; i < 50; ++i)
    pairs.push_back(
        {testing::normal_displacement(random, 0.2, 1), testing::normal_displacement(random, 0.2, 1)});
  CalibrationOptions options;
  options.pairing.robust = false;
  EXPECT_EQ(calibrate(pairs, options).verdict, Verdict::contradictory);
}

TEST(Verdict, OfMotionPairsThatAgree) {
  testing::Random random(6);
  testing::RandomDrive motions;
  motions.noise = 0.01;
  const auto pairs = testing::random_pairs(testing::random_extrinsic(random), motions, random);
  const Calibration calibration = calibrate(pairs);
  EXPECT_EQ(calibration.verdict, Verdict::good) << calibration.reason;
  EXPECT_LT(calibration.fit.translation_relative_median, 0.1);
}

TEST(Verdict, OfCleanRealDrives) {
  if (!testing::have_real_drives()) GTEST_SKIP() << "no real drives in " << paths::data_dir();
  for (const testing::Streams& streams : {testing::kitti("07"), testing::euroc(), testing::robot_arm(),
                                          testing::planar(testing::kitti("07"))}) {
    CalibrationOptions options;
    options.pairing = streams.options;
    const Calibration calibration = calibrate(streams.a, streams.b, options);
    EXPECT_LE(calibration.verdict, Verdict::incomplete) << calibration.reason;
    for (const Finding& finding : calibration.findings) EXPECT_FALSE(finding.certain) << finding.message;
  }
}

TEST(Verdict, OfOneStreamInvertedInARealFlightNamesBothReadingsThatFit) {
  if (!testing::have_real_drives()) GTEST_SKIP() << "no real drives in " << paths::data_dir();
  const testing::Streams streams = testing::euroc();
  const Calibration calibration = calibrate(testing::inverted(streams.a), streams.b, CalibrationOptions{});
  EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
  ASSERT_EQ(calibration.findings.size(), 2u) << calibration.reason;
  EXPECT_TRUE(calibration.findings[0].code.starts_with("inverted_")) << calibration.findings[0].code;
  EXPECT_TRUE(calibration.findings[1].code.starts_with("inverted_")) << calibration.findings[1].code;
}

TEST(Verdict, OfBothStreamsInvertedOnARealRoad) {
  if (!testing::have_real_drives()) GTEST_SKIP() << "no real drives in " << paths::data_dir();
  testing::Streams streams = testing::kitti("07");
  const Calibration calibration =
      calibrate(testing::inverted(streams.a), testing::inverted(streams.b), CalibrationOptions{});
  EXPECT_EQ(calibration.verdict, Verdict::contradictory) << calibration.reason;
  ASSERT_FALSE(calibration.findings.empty());
  EXPECT_EQ(calibration.findings.front().code, "inverted_both");
}

/// The ends of the lines were measured: they have another answer where much is lost between them.
TEST(Verdict, OfPositionsOnLinesIsNotGoodWhereTheirEndsHaveAnotherAnswer) {
  SimulationOptions options;
  options.poses = 1201;
  options.rate = 20;
  options.relative_noise = 0.002;
  options.speed_variation = 0.3;
  const testing::Streams right = testing::simulated_drive(options);
  const auto verdict_of = [&](std::size_t each) {
    const Trajectory lines = testing::interpolated(right.b, each);
    Trajectory b = right.b;
    for (std::size_t i = 0; i < b.size(); ++i)
      b[i].pose = canonical_sign(
          to_dual_quaternion(Pose{to_pose(right.b[i].pose).rotation, to_pose(lines[i].pose).translation}));
    return calibrate(right.a, b);
  };
  EXPECT_EQ(verdict_of(20).verdict, Verdict::incomplete) << "75 cm off: " << verdict_of(20).reason;
  EXPECT_EQ(verdict_of(4).verdict, Verdict::good) << "4 cm off: " << verdict_of(4).reason;
}

// The standard deviations of an answer with a wrong scale are those of lengths that do not fit.
TEST(Verdict, AClearlyWrongScaleIsDoubtfulWhereItMovesTheAnswerByMoreThanItStates) {
  Answered answered;
  answered.observability.observable.fill(true);
  answered.observability.stddev.fill(0.005);
  const auto verdict_of = [&](double scale, double moved) {
    Diagnosis diagnosis;
    Finding finding;
    finding.code = "scale";
    finding.certain = true;
    finding.improvement = 5;
    finding.value = scale;
    finding.T_a_b = Pose{Eigen::Quaterniond::Identity(), {moved, 0, 0}};
    diagnosis.findings = {finding};
    detail::judge(diagnosis, answered, {}, {});
    return diagnosis.verdict;
  };
  EXPECT_EQ(verdict_of(0.91, 0.009), Verdict::doubtful);
  EXPECT_LE(verdict_of(0.91, 0.003), Verdict::incomplete) << "within what the answer states";
  EXPECT_LE(verdict_of(0.983, 0.009), Verdict::incomplete) << "as far as real sensors differ";
  EXPECT_EQ(verdict_of(0.983, 0.018), Verdict::doubtful);
}

// Half a minute on rails knows x to metres, and a clock that noise showed was a contradiction.
TEST(Verdict, AClockContradictsTheAnswerBeyondWhatItStates) {
  const auto verdict_of = [](double stddev, double improvement, double offset = 0.02) {
    Answered answered;
    answered.observability.observable.fill(true);
    answered.observability.stddev.fill(stddev);
    answered.timing_stddev[0] = 1.5;  // what the clock moves is stated as well
    Diagnosis diagnosis;
    Finding finding;
    finding.code = "clock_offset";
    finding.value = offset;
    finding.certain = true;
    finding.improvement = improvement;
    finding.T_a_b = Pose{Eigen::Quaterniond::Identity(), {1.5, 0, 0}};
    diagnosis.findings = {finding};
    detail::judge(diagnosis, answered, {}, {});
    return diagnosis.verdict;
  };
  EXPECT_EQ(verdict_of(0.5, 2), Verdict::contradictory);
  EXPECT_EQ(verdict_of(1, 2), Verdict::incomplete);
  EXPECT_EQ(verdict_of(1, 1000), Verdict::contradictory) << "the motions say so whatever the answer states";
  EXPECT_EQ(verdict_of(1, 2, -3.3), Verdict::contradictory) << "no noise shows that: two drives";
}

// Noise that wanders looks like a mounting that moves a little. Where the two cannot be told apart, the
// verdict depends on how far this answer is from the one after the move.
TEST(Verdict, APossibleMoveIsDoubtfulWhereTheAnswerAfterItIsFar) {
  Answered answered;
  answered.observability.observable.fill(true);
  answered.observability.stddev.fill(0.005);
  const auto verdict_of = [&](bool certain, double moved, const char* beside = "clock_drift") {
    Diagnosis diagnosis;
    Finding finding, other;
    other.code = beside;
    finding.code = "mount_moved";
    finding.certain = certain;
    finding.T_a_b = Pose{Eigen::Quaterniond::Identity(), {moved, 0, 0}};
    diagnosis.findings = {finding, other};
    detail::judge(diagnosis, answered, {}, {});
    return diagnosis.verdict;
  };
  EXPECT_LE(verdict_of(false, 0.1), Verdict::incomplete);
  EXPECT_EQ(verdict_of(false, 0.1, "inverted_both"), Verdict::doubtful) << "streams that may be inverted";
  EXPECT_EQ(verdict_of(false, 0.5), Verdict::doubtful);
  EXPECT_EQ(verdict_of(true, 0.1), Verdict::doubtful) << "a move that is certain";
}

}  // namespace
}  // namespace egocal::test_verdict
