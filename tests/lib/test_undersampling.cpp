// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What interpolation loses of motions that are too fast for a sensor is counted as unknown, and is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../support/shaken_car.hpp"
#include "../support/simulated_drive.hpp"
#include "diagnosis/streams/undersampling.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/scale/scale_statistics.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_undersampling {
namespace {

const Finding* undersampled(const Calibration& calibration) {
  for (const Finding& finding : calibration.findings)
    if (finding.code.starts_with("undersampled_")) return &finding;
  return nullptr;
}

testing::Streams shaken(double rate_a, double rate_b, double lowest, double highest, std::uint64_t seed) {
  testing::ShakenCar car;
  car.rate_a = rate_a;
  car.rate_b = rate_b;
  car.phase_b = 0.4 / rate_b;
  car.lowest = lowest;
  car.highest = highest;
  car.seed = seed;
  return testing::shaken_car(car);
}

// Shaken about as fast as a sensor measures, up to beyond half its rate.
TEST(Undersampling, CountsAsUnknown) {
  double squares = 0, squares_stated = 0;
  int named = 0, drives = 0, beyond = 0;
  for (const auto& [rate_a, rate_b] : {std::pair{10.0, 10.0}, std::pair{15.0, 8.0}, std::pair{10.0, 20.0}})
    for (const auto& [lowest, highest] : {std::pair{2.0, 6.0}, std::pair{4.0, 9.0}})
      for (std::uint64_t seed = 1; seed <= 3; ++seed, ++drives) {
        const testing::Streams streams = shaken(rate_a, rate_b, lowest, highest, seed);
        CalibrationOptions motions_alone;
        motions_alone.diagnosis.enabled = false;
        const Calibration plain = calibrate(streams.a, streams.b, motions_alone),
                          found = calibrate(streams.a, streams.b);
        const detail::Vector6d error = detail::frame_a_difference(streams.T, to_dual_quaternion(found.T_a_b));
        double worst = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          const double size = error[static_cast<Eigen::Index>(i)];
          squares += std::pow(size / plain.observability.stddev[i], 2) / 3;
          squares_stated += std::pow(size / found.observability.stddev[i], 2) / 3;
          worst = std::max(worst, std::abs(size) / found.observability.stddev[i]);
        }
        beyond += worst > 4;
        const Finding* finding = undersampled(found);
        named += finding != nullptr;
        if (finding) {
          EXPECT_EQ(finding->code, rate_a >= rate_b && rate_a != rate_b ? "undersampled_a" : finding->code);
          EXPECT_LT(found.verdict, Verdict::doubtful) << found.reason;
        }
        std::printf("%g and %g Hz, shaken at %g to %g Hz: %.1f standard deviations%s\n", rate_a, rate_b,
                    lowest, highest, worst, finding ? ", named" : "");
      }
  std::printf("errors in standard deviations: %.2f of the motions alone, %.2f with interpolation\n",
              std::sqrt(squares / drives), std::sqrt(squares_stated / drives));
  EXPECT_GT(std::sqrt(squares / drives), 1.5);
  EXPECT_LT(std::sqrt(squares_stated / drives), 1.3);
  EXPECT_GE(named, drives / 4);
  EXPECT_LE(beyond, 1);
}

TEST(Undersampling, IsNotNamedWhereBothMeasureAtTheSameTimes) {
  testing::ShakenCar car;
  car.rate_b = 10;
  car.phase_b = 0;
  car.lowest = 2;
  car.highest = 6;
  const testing::Streams streams = testing::shaken_car(car);
  const Calibration found = calibrate(streams.a, streams.b);
  EXPECT_EQ(undersampled(found), nullptr);
  CalibrationOptions motions_alone;
  motions_alone.diagnosis.enabled = false;
  EXPECT_EQ(found.observability.stddev, calibrate(streams.a, streams.b, motions_alone).observability.stddev);
}

TEST(Undersampling, IsNotNamedOfSlowMotions) {
  for (const auto& [rate_a, rate_b] : {std::pair{10.0, 20.0}, std::pair{10.0, 10.0}, std::pair{20.0, 8.0}})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const testing::Streams streams = shaken(rate_a, rate_b, 0.3, 0.9, seed);
      const Calibration found = calibrate(streams.a, streams.b);
      EXPECT_EQ(undersampled(found), nullptr) << rate_a << " and " << rate_b << " Hz, seed " << seed;
    }
}

// The standard deviation of the scale of long motions is that of the shaking; motions of all lengths know it.
TEST(Undersampling, AWrongScaleIsNamedNevertheless) {
  for (const double scale : {1.0, 1.02, 0.98})
    for (const std::uint64_t seed : {3u, 4u}) {
      testing::ShakenCar car;
      car.rate_a = car.rate_b = 10;
      car.phase_b = 0.04;
      car.lowest = 2;
      car.highest = 6;
      car.size = 0.04;
      car.seconds = 120;
      car.seed = seed;
      const testing::Streams streams = testing::shaken_car(car);
      const Calibration calibration = calibrate(streams.a, scaled(streams.b, scale));
      const bool named = std::any_of(calibration.findings.begin(), calibration.findings.end(),
                                     [](const Finding& one) { return one.code == "scale" && one.certain; });
      EXPECT_EQ(named, scale != 1) << scale << ", seed " << seed;
    }
}

}  // namespace
}  // namespace egocal::test_undersampling
