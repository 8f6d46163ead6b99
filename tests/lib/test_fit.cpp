// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How well an answer explains the motions, in units that a person judges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/mistakes.hpp"
#include "../support/standing.hpp"
#include "diagnosis/motions/fit.hpp"
#include "diagnosis/motions/robust_fit.hpp"

namespace egocal::test_fit {
namespace {

using detail::Motions;

Motions motions_of(const testing::Streams& streams, int stride) {
  return detail::motions_of(detail::synchronised(streams.a, streams.b, {}, 0.5), {}, {}, stride, 10'000);
}

testing::Streams drive(Terrain terrain, double noise = 0) {
  return testing::noisy_drive(terrain, noise, 301);
}

TEST(Fit, IsZeroAtTheTruthOfPerfectMotions) {
  const testing::Streams streams = drive(Terrain::free);
  const Fit fit = detail::fit_at(motions_of(streams, 5), to_pose(streams.T), 0.5);
  EXPECT_LT(fit.rotation_95, 1e-6);
  EXPECT_LT(fit.translation_95, 1e-6);
  EXPECT_LT(fit.translation_relative_median, 1e-6);
  EXPECT_NEAR(fit.turning_ratio, 1, 1e-9);
}

/// Free motion without noise, with the stamps of the sensors 0.37 periods apart.
testing::Streams unlike_stamps(double rate) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = static_cast<int>(60 * rate);
  options.rate = rate;
  options.faults.resize(2);
  options.faults[1].phase = 0.37 / rate;
  return testing::simulated_drive(options);
}

TEST(Fit, OfStreamsThatAreNotMeasuredAtTheSameTimesIsNotThatOfTheInterpolation) {
  for (const auto& [rate, most] : {std::pair{4.0, 0.002}, std::pair{10.0, 1e-4}}) {
    const testing::Streams streams = unlike_stamps(rate);
    const Fit fit = detail::fit_at(motions_of(streams, static_cast<int>(rate)), to_pose(streams.T), 0.5);
    EXPECT_LT(fit.translation_relative_median, most) << rate << " Hz";
  }
}

TEST(Fit, ASpikeIsNotSpreadOverItsNeighbours) {
  testing::Streams streams = unlike_stamps(10);
  const std::size_t at = 300;
  const DualQuaternion before = streams.b[at].pose;
  streams.b[at].pose = normalized(before * testing::displacement({0, 0, 0.1}, {1, 0, 0}));
  const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const auto nearest =
        std::min_element(streams.b.begin(), streams.b.end(), [&](const auto& x, const auto& y) {
          const auto off = [&](const StampedPose& pose) {
            return std::abs(1e-6 * static_cast<double>(pose.time_us - streams.a.front().time_us) -
                            instants.time(i));
          };
          return off(x) < off(y);
        });
    wrong += translation_length(motion_between(nearest->pose, instants.at(i).b)) > 0.05 ? 1 : 0;
  }
  EXPECT_LE(wrong, 2u);
}

TEST(Fit, MeasuresAWrongRotationInRadiansAndMetres) {
  // motions of one metre along x without turning: an extrinsic turned by phi about z misses by 2 sin(phi / 2)
  Motions motions;
  std::vector<MotionPair> pairs(
      20, {testing::displacement({0, 0, 0}, {1, 0, 0}), testing::displacement({0, 0, 0}, {1, 0, 0})});
  motions = detail::motions_of(pairs);
  const double phi = 0.1;
  const Fit fit = detail::fit_at(motions, {rotation_exp({0, 0, phi}), {0, 0, 0}}, 0);
  EXPECT_NEAR(fit.translation_median, 2 * std::sin(phi / 2), 1e-12);
  EXPECT_NEAR(fit.translation_relative_median, 2 * std::sin(phi / 2), 1e-12);
  EXPECT_NEAR(fit.rotation_median, 0, 1e-12);
}

TEST(Fit, ShowsTheRatioOfLengthsAndOfTurning) {
  testing::Streams streams = drive(Terrain::rough);
  streams.b = testing::lengthened(streams.b, 0.25);
  const Fit fit = detail::fit_at(motions_of(streams, 5), to_pose(streams.T), 0.5);
  EXPECT_NEAR(fit.length_ratio, 0.25, 0.01);
  EXPECT_NEAR(fit.turning_ratio, 1, 1e-6);
}

TEST(Fit, MediansDoNotFeelASingleJump) {
  testing::Streams streams = drive(Terrain::rough, 0.01);
  const Fit before = detail::fit_at(motions_of(streams, 5), to_pose(streams.T), 0.5);
  streams.b = testing::knocked(streams.b, 0.5, {rotation_exp({0, 0, 0}), {100, 0, 0}});
  for (std::size_t i = streams.b.size() / 2 + 1; i < streams.b.size(); ++i)
    streams.b[i].pose = normalized(streams.b[i].pose * testing::displacement({0, 0, 0}, {-100, 0, 0}));
  const Fit after = detail::fit_at(motions_of(streams, 5), to_pose(streams.T), 0.5);
  EXPECT_LT(after.translation_median, 1.1 * before.translation_median);
}

TEST(Fit, TenthsShowWhereTheMountMoved) {
  testing::Streams streams = drive(Terrain::free, 0.001);
  streams.b = testing::knocked(streams.b, 0.7, {rotation_exp({0, 0, 0.2}), {0.1, 0, 0}});
  const Fit fit = detail::fit_at(motions_of(streams, 5), to_pose(streams.T), 0.5);
  ASSERT_EQ(fit.tenths.size(), 10u);
  EXPECT_LT(fit.tenths[2].translation_relative, 0.01);
  EXPECT_GT(fit.tenths[9].translation_relative, 0.05);
}

// a residual of 0.00 % of the distance looked like the best tenth of the drive
TEST(Fit, ATenthAtRestHasNoResidualAsAPartOfTheDistance) {
  testing::Streams streams = drive(Terrain::free, 0.001);
  testing::Random random(3);
  for (Trajectory* one : {&streams.a, &streams.b})
    *one = testing::with_stand(*one, 150, 300, 100'000, 1e-4, random);
  const Fit fit = detail::fit_at(motions_of(streams, 5), to_pose(streams.T), 0.5);
  ASSERT_EQ(fit.tenths.size(), 10u);
  EXPECT_TRUE(std::isnan(fit.tenths[4].translation_relative));
  EXPECT_GT(fit.tenths[4].translation_median, 0);
  EXPECT_LT(fit.tenths[1].translation_relative, 0.01);
}

TEST(Comparison, FavoursTheTruthAndIsAntisymmetric) {
  const testing::Streams streams = drive(Terrain::free, 0.02);
  const Motions motions = motions_of(streams, 5);
  const detail::Explained right{motions, detail::evaluated(motions, streams.T)};
  const detail::Explained wrong{
      motions, detail::evaluated(motions, streams.T * testing::displacement({0.1, 0, 0}, {0, 0, 0}))};
  const detail::Comparison forth = detail::compare(wrong, right), back = detail::compare(right, wrong);
  EXPECT_GT(forth.gain, 0.3);
  EXPECT_GT(forth.sigmas, 3.5);
  EXPECT_NEAR(forth.gain, -back.gain, 1e-12);
  EXPECT_NEAR(forth.sigmas, -back.sigmas, 1e-12);
  EXPECT_EQ(detail::compare(right, right).sigmas, 0);
}

TEST(RobustFit, StandsAFifthOfGrossOutliers) {
  const testing::Streams streams = drive(Terrain::free, 0.01);
  Motions motions = motions_of(streams, 5);
  testing::Random random(3);
  for (std::size_t i = 0; i < motions.all.size(); i += 5)
    motions.all[i].b = motions.all[i].b * testing::normal_displacement(random, 0.5, 5);
  const DualQuaternion T = detail::robust_fit(motions).T;
  EXPECT_LT(screw_of(conjugate(streams.T) * T).angle, 0.02);
}

}  // namespace
}  // namespace egocal::test_fit
