// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Sensors that stand for most of a drive, with noise on their poses: noise compared with noise says nothing.
#include <gtest/gtest.h>

#include <algorithm>

#include "../support/bounded_drive.hpp"
#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/standing.hpp"
#include "diagnosis/motions/fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_at_rest {
namespace {

constexpr std::int64_t period_us = 100'000;

/// Half a minute on rough ground, and a stop of `stand` times as long, with a jitter of b of 1 cm and 1 mrad.
testing::Streams standing(double stand, bool at_begin, std::uint64_t seed) {
  testing::Streams streams = testing::drive(Terrain::rough, seed);
  streams.a.resize(301);
  streams.b.resize(301);
  testing::Random random(seed + 100);
  const auto periods = static_cast<std::int64_t>(stand * 301);
  const std::size_t at = at_begin ? 0 : 300;
  streams.a = testing::with_stand(streams.a, at, periods, period_us, 0.001, random);
  streams.b = testing::with_stand(streams.b, at, periods, period_us, 0.01, random);
  return streams;
}

TEST(AtRest, MotionsThatAreNoiseAreLeftOut) {
  const testing::Streams streams = standing(2, false, 1);
  const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
  const detail::Motions motions = detail::motions_of(instants, {}, {}, 8, 10'000);
  const detail::Motions moving = detail::without_rest(motions, to_pose(streams.T));
  const auto stands = [](const detail::Motion& motion) { return motion.time > 31; };
  const auto count = std::count_if(moving.all.begin(), moving.all.end(), stands);
  EXPECT_LT(static_cast<double>(count), 0.05 * static_cast<double>(motions.all.size()));
  EXPECT_GT(moving.all.size(), 270u);
  EXPECT_GT(moving.translation, 2 * motions.translation);
}

TEST(AtRest, WhatMovesIsKeptHoweverWrongTheAnswerIs) {
  const testing::Streams streams = testing::drive(Terrain::rough);
  const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
  const detail::Motions motions = detail::motions_of(instants, {}, {}, 8, 10'000);
  const Pose wrong = to_pose(streams.T) * Pose{rotation_exp({0, 0, 2}), {1, 2, 3}};
  EXPECT_EQ(detail::without_rest(motions, wrong).all.size(), motions.all.size());
}

TEST(AtRest, HasNoPartOfTheDistance) {
  const testing::Streams streams = standing(2, false, 1);
  const detail::Instants instants = detail::synchronised(streams.a, streams.b, {}, 0.5);
  const Fit fit = detail::fit_at(detail::motions_of(instants, {}, {}, 8, 10'000), to_pose(streams.T), 0.8);
  EXPECT_LT(fit.translation_relative_median, 0.05);
}

/// A hand-held rig.
TEST(AtRest, DoesNotMakeARightAnswerDoubtful) {
  for (const bool at_begin : {false, true})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      testing::Streams streams = testing::bounded_drive();
      testing::Random random(seed);
      const std::size_t at = at_begin ? 0 : streams.a.size() - 1;
      const auto periods = static_cast<std::int64_t>(2 * streams.a.size());
      streams.a = testing::with_stand(streams.a, at, periods, period_us, 0.002, random);
      streams.b = testing::with_stand(streams.b, at, periods, period_us, 0.01, random);
      const Calibration calibration = calibrate(streams.a, streams.b);
      EXPECT_LE(calibration.verdict, Verdict::incomplete) << seed << ": " << calibration.reason;
      EXPECT_EQ(testing::find(calibration, "scale_change"), nullptr) << seed;
      EXPECT_EQ(testing::find(calibration, "mount_moved"), nullptr) << seed;
    }
}

/// An odometry without noise stays where it is to the last digit; its heading creeps. Its positions are not
/// missing because the other one is noisy.
TEST(AtRest, NothingIsMissingFromAVehicleThatStands) {
  testing::Random random(5);
  testing::Streams streams;
  const Pose at_b{rotation_exp({0.3, -0.2, 1}), {4, 5, 6}};
  for (std::int64_t i = 0; i < 200; ++i) {
    const double creep = 2e-5 * static_cast<double>(i);
    streams.a.push_back(
        {i * period_us, to_dual_quaternion(Pose{rotation_exp({0, 0, creep}), {-8.39, -11.4, 42.8}})});
    streams.b.push_back(
        {i * period_us,
         to_dual_quaternion(at_b) * testing::displacement(random.normal3(0.004), random.normal3(0.014))});
  }
  const Calibration calibration = calibrate(streams.a, streams.b);
  EXPECT_EQ(calibration.verdict, Verdict::incomplete) << calibration.reason;
  EXPECT_NE(testing::find(calibration, "too_little_motion"), nullptr);
  EXPECT_EQ(testing::find(calibration, "missing_a"), nullptr);
}

}  // namespace
}  // namespace egocal::test_at_rest
