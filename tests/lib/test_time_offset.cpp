// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The offset of two clocks from the whole of both streams.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/clock_drives.hpp"
#include "../support/shaken_car.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::test_time_offset {
namespace {

using namespace testing;

TEST(TimeOffset, IsFoundWhateverItIsAndItsDeviationTellsTheError) {
  int outside = 0, runs = 0;
  for (const double noise : {0.001, 0.02})
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
      for (const double shift : {-300.0, -0.037, 12.34, 300.0}) {
        const Streams data = simulated(noise, seed, 60);
        const auto offset = estimate_time_offset(data.a, thinned(shifted(data.b, shift), 0.3, seed));
        ASSERT_TRUE(offset);
        EXPECT_NEAR(offset->seconds, -shift, 0.005) << noise << " " << seed;
        EXPECT_GT(offset->correlation, 0.8);
        EXPECT_LT(offset->stddev, 0.005);
        outside += std::abs(offset->seconds + shift) > 3 * offset->stddev + 2e-4;
        ++runs;
      }
  EXPECT_LE(outside, runs / 10) << "of " << runs;
}

// Offsets were up to 10 ms wrong with half a period between the three that are compared.
TEST(TimeOffset, OfAShakenCarIsFound) {
  for (const auto& [rate_a, rate_b] : {std::pair{10.0, 20.0}, std::pair{10.0, 10.0}, std::pair{20.0, 20.0}})
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      testing::ShakenCar car;
      car.rate_a = rate_a;
      car.rate_b = rate_b;
      car.lowest = 2;
      car.highest = 4;
      car.phase_b = 0.4 / rate_b;
      car.seed = seed;
      const Streams streams = testing::shaken_car(car);
      const auto offset = estimate_time_offset(streams.a, streams.b);
      ASSERT_TRUE(offset);
      std::printf("%g and %g Hz: %.2f ms off, standard deviation %.2f ms\n", rate_a, rate_b,
                  1e3 * offset->seconds, 1e3 * offset->stddev);
      EXPECT_LT(std::abs(offset->seconds), 0.001);
    }
}

TEST(TimeOffset, GlitchesDoNotMoveIt) {
  for (const double part : {0.01, 0.05, 0.1})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const Streams data = simulated(0.01, seed, 60);
      const auto offset = estimate_time_offset(glitched(data.a, part, seed),
                                               shifted(glitched(data.b, part, seed + 10), 12.34));
      ASSERT_TRUE(offset);
      EXPECT_NEAR(offset->seconds, -12.34, 0.002) << part << " " << seed;
      EXPECT_LT(offset->stddev, 0.002) << part << " " << seed;
      EXPECT_GT(offset->correlation, 0.9) << part << " " << seed;
      EXPECT_GT(offset->inliers, 0.9 - 2 * part);
    }
}

// It was up to a minute wrong, or 0.3 s with a standard deviation of 3 ms.
TEST(TimeOffset, LastingJumpsDoNotMoveIt) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const std::size_t jumps : {1, 6})
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Streams data = testing::simulated_drive(
            {.terrain = terrain, .poses = 601, .rate = 10, .speed = 8, .relative_noise = 0.01, .seed = seed});
        const auto offset = estimate_time_offset(jumping(data.a, jumps, seed),
                                                 shifted(jumping(data.b, jumps, seed + 10), 12.34));
        ASSERT_TRUE(offset);
        EXPECT_NEAR(offset->seconds, -12.34, 3 * offset->stddev + 0.001) << jumps << " " << seed;
        EXPECT_LT(offset->stddev, 0.01) << jumps << " " << seed;
      }
}

TEST(TimeOffset, ADriftIsReportedWithItsDeviationAndCorrected) {
  for (const double noise : {0.001, 0.01})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const Streams data = simulated(noise, seed, 240);
      for (const double rate : {1e-3, -5e-4, 0.0}) {
        const Trajectory b = shifted(drifting(data.b, rate), -40);
        const auto offset = estimate_time_offset(data.a, b);
        ASSERT_TRUE(offset);
        EXPECT_EQ(offset->drifts, rate != 0) << noise << " " << seed << " " << rate;
        EXPECT_NEAR(offset->rate, rate / (1 - rate), 6 * offset->rate_stddev + 1e-6);
        EXPECT_LT(offset->rate_stddev, 2e-5);
        const Trajectory corrected = on_clock_of_a(*offset, b);
        for (const std::size_t i : {std::size_t{0}, b.size() / 2, b.size() - 1})
          EXPECT_NEAR(1e-6 * static_cast<double>(corrected[i].time_us - data.b[i].time_us), 0, 0.003);
      }
    }
}

/// A second of drift smears the correlation of the whole.
TEST(TimeOffset, ALongDriftingDriveIsFollowed) {
  const Streams data = testing::simulated_drive(
      {.terrain = Terrain::free, .poses = 12'000, .rate = 10, .relative_noise = 0.01, .seed = 4});
  const Trajectory b = drifting(data.b, 1e-3);
  const auto offset = estimate_time_offset(data.a, b);
  ASSERT_TRUE(offset);
  EXPECT_TRUE(offset->drifts);
  EXPECT_NEAR(offset->rate, 1e-3, 2e-5);
  const Trajectory corrected = on_clock_of_a(*offset, b);
  EXPECT_NEAR(1e-6 * static_cast<double>(corrected.back().time_us - data.b.back().time_us), 0, 0.005);
}

/// A first stamp of zero before dates would be a grid of thirty thousand million points.
TEST(TimeOffset, StrayStampsCostNoMemory) {
  const Streams data = simulated(0.01, 2, 60);
  for (const std::int64_t stray : {std::int64_t{0}, std::int64_t{4'000'000'000'000'000}}) {
    Trajectory b = shifted(data.b, 12.34);
    b.insert(stray == 0 ? b.begin() : b.end(), StampedPose{stray, {}});
    for (const auto& offset : {estimate_time_offset(data.a, b), estimate_time_offset(b, data.a)}) {
      ASSERT_TRUE(offset);
      EXPECT_NEAR(std::abs(offset->seconds), 12.34, 0.002);
    }
  }
  Trajectory invalid = data.b;
  invalid.insert(invalid.begin() + 5, StampedPose{std::numeric_limits<std::int64_t>::max(), {}});
  invalid[7].pose.dual[0] = std::numeric_limits<double>::quiet_NaN();
  std::swap(invalid[20], invalid[30]);
  const auto offset = estimate_time_offset(data.a, invalid);
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->seconds, 0, 0.002);
}

TEST(TimeOffset, DoesNotDependOnHowTheWorkIsDivided) {
  const Streams data = simulated(0.01, 2, 60);
  const Trajectory b = shifted(data.b, 3);
  const auto whole = estimate_time_offset(data.a, b);
  TimeOffsetSearch search(data.a, b);
  int steps = 1;
  while (!search.step(500)) ++steps;
  const auto divided = search.finish();
  EXPECT_GT(steps, 10);
  ASSERT_TRUE(whole && divided);
  EXPECT_EQ(whole->seconds, divided->seconds);
  EXPECT_EQ(whole->stddev, divided->stddev);
  EXPECT_EQ(whole->rate, divided->rate);
}

TEST(TimeOffset, OfUnrelatedStreamsIsNotTrusted) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto offset = estimate_time_offset(simulated(0.01, seed, 60).a, simulated(0.01, seed + 50, 60).b);
    EXPECT_FALSE(offset && offset->correlation > 0.7 && offset->stddev < 0.005 && offset->inliers > 0.5)
        << seed;
  }
}

TEST(TimeOffset, OfStreamsThatNeverTurnOrAreTooShortIsNotGuessed) {
  const Streams data = simulated(0.001, 1, 20);
  EXPECT_FALSE(estimate_time_offset({}, data.b));
  EXPECT_FALSE(estimate_time_offset(data.a, Trajectory(data.b.begin(), data.b.begin() + 9)));
  Trajectory still = data.b;
  for (StampedPose& pose : still) pose.pose = {};
  const auto offset = estimate_time_offset(data.a, still);
  EXPECT_TRUE(!offset || offset->correlation < 0.5 || !(offset->stddev < 0.005));
}

}  // namespace
}  // namespace egocal::test_time_offset
