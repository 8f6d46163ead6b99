// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rotations that a filter smooths and delays, beside positions that are on time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "../support/tractor.hpp"
#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/explanations/times/smoothed_rotations.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/pairing/options.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::test_smoothed_rotations {
namespace {

constexpr double period = 0.1, time_constant = 0.15;  // of the tractor's poses, and of the filter [s]

/// What the last pose keeps of each new one through a filter of the first order.
double kept() {
  return std::exp(-period / time_constant);
}
double mean_delay() {
  return period * kept() / (1 - kept());
}
double variance_of_delay() {
  return period * period * kept() / ((1 - kept()) * (1 - kept()));
}

/// The rotations follow through the filter, the positions do not.
Trajectory with_smoothed_rotations(const Trajectory& given) {
  Trajectory result = given;
  Rotation rotation = to_pose(given.front().pose).rotation;
  for (std::size_t i = 1; i < given.size(); ++i) {
    Pose pose = to_pose(given[i].pose);
    pose.rotation = rotation = rotation.slerp(1 - kept(), pose.rotation);
    result[i].pose = canonical_sign(to_dual_quaternion(pose));
  }
  return result;
}

Trajectory later_by(Trajectory poses, double seconds) {
  for (StampedPose& pose : poses) pose.time_us += std::llround(1e6 * seconds);
  return poses;
}

/// clock: added to the stamps of b [s].
std::optional<detail::SmoothedRotations> found_in(const testing::Streams& streams, double clock, Side side) {
  const DiagnosisOptions options;
  const detail::Evidence evidence =
      detail::gather(streams.a, streams.b, {clock, 0, 0}, PairingOptions().max_gap, options);
  return detail::smoothed_rotations(evidence.instants, evidence.given.explained, side);
}

TEST(SmoothedRotations, WidthOfTheFilterIsFoundInEitherStream) {
  for (const Side side : {Side::a, Side::b}) {
    testing::Streams streams = testing::tractor(1, 0);
    Trajectory& wrong = side == Side::a ? streams.a : streams.b;
    wrong = with_smoothed_rotations(wrong);
    const double clock = side == Side::a ? mean_delay() : -mean_delay();
    const std::optional<detail::SmoothedRotations> found = found_in(streams, clock, side);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->delay, 0, 0.1 * mean_delay());
    EXPECT_NEAR(found->variance, variance_of_delay(), 0.25 * variance_of_delay());
    EXPECT_GT(found->sigmas(), detail::SmoothedRotationsOptions().sigmas);
    EXPECT_GT(found->gain, detail::SmoothedRotationsOptions().least_gain);
    EXPECT_GT(found->agreement, detail::SmoothedRotationsOptions().agreement);
    const std::optional<detail::SmoothedRotations> other =
        found_in(streams, clock, side == Side::a ? Side::b : Side::a);
    ASSERT_TRUE(other);
    EXPECT_LT(other->variance, 0);
  }
}

TEST(SmoothedRotations, AClockIsNoFilter) {
  const testing::Streams given = testing::tractor(1, 0);
  for (const double late : {0.0, 0.1}) {
    const testing::Streams streams{given.T, given.a, later_by(given.b, late), {}};
    for (const Side side : {Side::a, Side::b}) {
      const std::optional<detail::SmoothedRotations> found = found_in(streams, -late, side);
      ASSERT_TRUE(found);
      EXPECT_LT(found->width(), 0.1 * mean_delay()) << late;
      EXPECT_LT(found->agreement, detail::SmoothedRotationsOptions().agreement) << late;
    }
    EXPECT_EQ(testing::find(calibrate(streams.a, streams.b), "late_positions_b"), nullptr) << late;
  }
}

/// Largest error of the answer in what it states.
double largest_in_stddevs(const Calibration& calibration, const DualQuaternion& T) {
  const detail::Vector6d error = detail::frame_a_difference(calibration.T_a_b, T);
  double largest = 0;
  for (std::size_t i = 0; i < 6; ++i)
    if (calibration.observability.observable[i])
      largest = std::max(largest,
                         std::abs(error[static_cast<Eigen::Index>(i)]) / calibration.observability.stddev[i]);
  return largest;
}

// At one speed the answer at the clock of the rotations leaves no residual. It was good, 20 cm and up to 14
// standard deviations off, and nothing but the clock was named.
TEST(SmoothedRotations, WidenWhatIsStated) {
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    testing::Streams streams = testing::tractor(seed, 0);
    streams.b = with_smoothed_rotations(streams.b);
    for (const bool estimate : {false, true}) {
      CalibrationOptions options;
      options.estimate_time_offset = estimate;
      const Calibration calibration = calibrate(streams.a, streams.b, options);
      const Finding* const found = testing::find(calibration, "late_positions_b");
      const std::array<bool, 6>& known = calibration.observability.observable;
      // beside the wrong clock a drive may not show the translation at all: then nothing wrong is stated
      if (!estimate && !known[0] && !known[1] && !known[2]) continue;
      ASSERT_NE(found, nullptr) << calibration.reason;
      ++named;
      EXPECT_FALSE(found->certain);
      EXPECT_NEAR(*found->value, -mean_delay(), 0.5 * mean_delay());
      EXPECT_LT(largest_in_stddevs(calibration, streams.T), 3) << seed << estimate;
      EXPECT_LT(extrinsic_error(streams.T, to_dual_quaternion(*found->T_a_b)).translation, 0.12);
    }
  }
  EXPECT_GE(named, 3);
}

}  // namespace
}  // namespace egocal::test_smoothed_rotations
