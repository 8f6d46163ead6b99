// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Time offsets of drives that repeat themselves.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "../support/measured_body.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "pairing/offset/correlation.hpp"

namespace egocal::test_repeating_motion {
namespace {

using testing::BodyPath, testing::body_step, testing::measured, testing::Sensor, testing::Streams;

/// Turning rate and velocity of a body in its own frame [rad/s, m/s].
struct Rates {
  Eigen::Vector3d turning, speed;
};

struct Drive {
  double seconds = 40, late = 0;  ///< late: of b's stamps [s]
  double rate_a = 20, rate_b = 15, noise_angle = 5e-4, noise_step = 1e-3;
  std::uint64_t seed = 1;
};

template <typename RatesAt>
Streams driven(const Drive& drive, RatesAt rates_at) {
  BodyPath body{{}};
  for (int i = 1; i * body_step < drive.seconds + 1; ++i) {
    const Rates rates = rates_at(i * body_step);
    body.push_back(body.back() * Pose{rotation_exp(body_step * rates.turning), body_step * rates.speed});
    body.back().rotation.normalize();
  }
  testing::Random random(drive.seed);
  const Pose on_a{rotation_exp({0.3, -0.2, 0.1}), {0.3, 0.1, 0.2}},
      on_b{rotation_exp({0.5, 0.8, -0.4}), {-0.4, 0.3, -0.1}};
  Streams streams;
  streams.T = to_dual_quaternion(inverse(on_a) * on_b);
  streams.a =
      measured(random, body, drive.seconds, {on_a, drive.rate_a, 0, 0, drive.noise_angle, drive.noise_step});
  streams.b = measured(random, body, drive.seconds,
                       {on_b, drive.rate_b, 0.013, drive.late, drive.noise_angle, drive.noise_step});
  return streams;
}

constexpr double period = 5;                                // [s]
constexpr double circular = 2 * std::numbers::pi / period;  // [rad/s]

/// Left turns and right turns, on the flat: half a period later all is mirrored, as if b hung upside down.
Rates figure_eight(double t) {
  return {{0, 0, circular * std::cos(circular * t)}, {2, 0, 0}};
}

/// The same on hills.
Rates tilted_eight(double t) {
  return {{0.2 * circular * std::cos(2 * circular * t + 1), 0.25 * circular * std::sin(circular * t + 2),
           circular * std::cos(circular * t)},
          {2, 0, 0}};
}

/// Turns as fast half a period later, but not about mirrored axes.
Rates uneven_eight(double t) {
  return {{0.25 * circular * std::cos(2 * circular * t + 1), 0.3 * circular * std::sin(2 * circular * t + 2),
           circular * std::cos(circular * t)},
          {2, 0, 0}};
}

/// About an axis two metres above: half a period later as if b were on the other side of it.
Rates swing(double t) {
  const double rate = 0.6 * circular * std::cos(circular * t);
  return {{0, rate, 0.2 * circular * std::cos(circular * t + 0.7)}, {2 * rate, 0, 0}};
}

/// The speed is never quite the same.
Rates human_eight(double t) {
  const double phase = circular * t + 0.5 * std::sin(0.21 * t) + 0.4 * std::sin(0.133 * t + 2);
  return {{0.25 * circular * std::cos(2 * phase + 1), 0.3 * circular * std::sin(2 * phase + 2),
           circular * std::cos(phase)},
          {2 + 0.3 * std::sin(0.17 * t), 0, 0}};
}

Rates car(double t) {
  return {{0.03 * std::sin(1.1 * t), 0.03 * std::sin(0.9 * t + 1),
           0.4 * std::sin(0.31 * t) + 0.3 * std::sin(0.17 * t + 1) + 0.2 * std::sin(0.73 * t + 2)},
          {8 + 2 * std::sin(0.13 * t), 0, 0}};
}

// Half a period or whole ones were found in half of such drives, to a millisecond as it seemed.
TEST(RepeatingMotion, ThatFitsAtManyOffsetsIsTakenAtTheLeast) {
  for (const auto& [name, rates, repeats] :
       {std::tuple{"figure eight", &figure_eight, period / 2},
        std::tuple{"uneven eight", &uneven_eight, period},
        std::tuple{"tilted eight", &tilted_eight, period / 2}, std::tuple{"swing", &swing, period / 2}})
    for (const double late : {0.0, -0.05, 0.4})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Streams streams = driven({.late = late, .seed = seed}, rates);
        const auto offset = estimate_time_offset(streams.a, streams.b);
        ASSERT_TRUE(offset);
        EXPECT_NEAR(offset->seconds, -late, 0.01) << name << " " << seed;
        ASSERT_TRUE(offset->rival) << name << " " << late << " " << seed;
        EXPECT_NEAR(std::abs(*offset->rival - offset->seconds), repeats, 0.02) << name << " " << seed;
        EXPECT_GE(offset->stddev, repeats - 0.02);
      }
}

TEST(RepeatingMotion, LateByAPeriodIsWithinTheStandardDeviation) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Streams streams = driven({.late = -period, .seed = seed}, uneven_eight);
    const auto offset = estimate_time_offset(streams.a, streams.b);
    ASSERT_TRUE(offset);
    EXPECT_NEAR(offset->seconds, 0, 0.01);
    EXPECT_LE(std::abs(offset->seconds - period), 3 * offset->stddev);
  }
}

TEST(RepeatingMotion, ThatIsNeverQuiteTheSameShowsItsOffset) {
  for (const auto rates : {&human_eight, &car})
    for (const double late : {0.0, 0.4, -period})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Streams streams = driven({.late = late, .seed = seed}, rates);
        const auto offset = estimate_time_offset(streams.a, streams.b);
        ASSERT_TRUE(offset);
        EXPECT_NEAR(offset->seconds, -late, 0.01) << seed;
        EXPECT_FALSE(offset->rival);
        EXPECT_LT(offset->stddev, 0.01);
      }
}

// Without noise only interpolation errors are left, and there are none if the stamps coincide.
TEST(RepeatingMotion, StampsThatCoincideAtAnotherOffsetDoNotDecide) {
  Drive drive;
  drive.rate_a = drive.rate_b = 20;
  drive.noise_angle = drive.noise_step = 1e-9;
  // 0.013 s before a pose of a; a period and 37 ms later they coincide
  const auto uneven = [](double t) {
    constexpr double slower = period / (period + 0.037);
    const Rates rates = uneven_eight(slower * t);
    return Rates{slower * rates.turning, rates.speed};
  };
  const Streams streams = driven(drive, uneven);
  const auto offset = estimate_time_offset(streams.a, streams.b);
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->seconds, 0, 0.002);
  EXPECT_TRUE(offset->rival);
}

// An offset that is known already is followed.
TEST(RepeatingMotion, NearAKnownOffsetLeavesNoDoubt) {
  const Streams streams = driven({.late = -0.02}, swing);
  TimeOffsetOptions options;
  options.near = 0;
  options.near_by = 3;
  const auto offset = estimate_time_offset(streams.a, streams.b, options);
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->seconds, 0.02, 0.005);
  EXPECT_FALSE(offset->rival);
  EXPECT_LT(offset->stddev, 0.005);
}

// With clocks that share nothing, no offset is likelier than the one with the longest overlap.
TEST(RepeatingMotion, OfClocksThatShareNothingOverlapsMost) {
  const Streams streams = driven({.late = 1000}, uneven_eight);
  const auto offset = estimate_time_offset(streams.a, streams.b);
  ASSERT_TRUE(offset);
  EXPECT_TRUE(offset->rival);
  EXPECT_LE(std::abs(offset->seconds + 1000), offset->stddev + 0.1);
  EXPECT_LE(std::abs(offset->seconds + 1000), 2.5 * period);
}

const Finding* uncertain_clock(const Calibration& calibration) {
  for (const Finding& finding : calibration.findings)
    if (finding.code == "clock_offset" && !finding.certain) return &finding;
  return nullptr;
}

TEST(RepeatingMotion, IsNamedBesideTheAnswer) {
  CalibrationOptions options;
  options.estimate_time_offset = true;
  // the same answer a period later
  const Streams uneven = driven({}, uneven_eight);
  const Calibration whole = calibrate(uneven.a, uneven.b, options);
  EXPECT_LT(extrinsic_error(uneven.T, to_dual_quaternion(whole.T_a_b)).rotation, 0.01);
  const Finding* finding = uncertain_clock(whole);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->message, "The motion repeats every 5 s: time offsets that differ by that fit as well.");
  EXPECT_EQ(whole.verdict, Verdict::good) << whole.reason;
  // another one half a period later
  const Streams mirrored = driven({}, tilted_eight);
  const Calibration half = calibrate(mirrored.a, mirrored.b, options);
  ASSERT_NE(uncertain_clock(half), nullptr);
  EXPECT_LT(extrinsic_error(mirrored.T, to_dual_quaternion(half.T_a_b)).rotation, 0.01);
  EXPECT_EQ(half.verdict, Verdict::incomplete);
  EXPECT_NE(half.reason.find("The answer would be another one, 180 deg"), std::string::npos) << half.reason;
  // without the option nothing is said
  EXPECT_EQ(uncertain_clock(calibrate(uneven.a, uneven.b)), nullptr);
}

/// What pairing adds to the stamps of b at the end of a live drive.
std::optional<double> followed(const Streams& streams) {
  PairingOptions options;
  options.track_time_offset = true;
  return paired(options, streams.a, streams.b).time_offset();
}

// Live, too: poses are held until the motion shows which of the offsets it is.
TEST(RepeatingMotion, IsNotFollowedLive) {
  EXPECT_FALSE(followed(driven({}, uneven_eight)));
  const std::optional<double> offset = followed(driven({.late = 0.4}, human_eight));
  ASSERT_TRUE(offset);
  EXPECT_NEAR(*offset, -0.4, 0.01);
}

TEST(Peaks, NoiseOnAWidePeakMakesNone) {
  const std::vector<float> values{0, 1, 5, 4.6F, 5.2F, 5, 1, 0, 3, 4, 2, 2.5F, 0, 6};
  const std::vector<detail::Peak> peaks = detail::peaks_of(values, -3, 3, 1);
  ASSERT_EQ(peaks.size(), 3u);
  EXPECT_EQ(peaks[0].lag, 1);
  EXPECT_EQ(peaks[1].lag, 6);
  EXPECT_EQ(peaks[2].lag, 10);  // at the end
  EXPECT_TRUE(detail::peaks_of({}, 0, 0, 1).empty());
  EXPECT_TRUE(detail::peaks_of(std::vector<float>(5, 0), 0, 0, 1).empty());
}

}  // namespace
}  // namespace egocal::test_repeating_motion
