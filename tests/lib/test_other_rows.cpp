// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions that belong to another row than the rotations beside them, or whose steps were turned by the
// attitude of another instant.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "../support/simulated_drive.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_other_rows {
namespace {

using testing::certain_finding;
using testing::expect_cured;
using testing::find;
using testing::with_positions_of_row;
using testing::with_turned_steps;

/// A car of 2 Hz that stops, backs and turns: at a constant speed these are poses of another point of the
/// body.
testing::Streams stop_and_go(std::uint64_t seed, double noise = 0.003) {
  testing::Random random(seed);
  const Pose mount{rotation_exp({0.1, -0.2, 0.7}), {0.8, -0.5, 0.3}};
  const auto noisy = [&](const Pose& step) {
    return Pose{step.rotation * rotation_exp(0.001 * random.normal3()),
                step.translation + noise * step.translation.norm() * random.normal3()};
  };
  testing::Streams streams;
  Pose a, b;
  for (int i = 0; i < 240; ++i) {
    const std::int64_t time_us = static_cast<std::int64_t>(i) * 500'000;
    streams.a.push_back({time_us, canonical_sign(to_dual_quaternion(a))});
    streams.b.push_back({time_us, canonical_sign(to_dual_quaternion(b))});
    const double speed = std::max(0.0, 6 + 6 * std::sin(0.11 * i));
    const Pose step{
        rotation_exp({0.05 * std::sin(0.7 * i), 0.04 * std::cos(0.9 * i), 0.15 * std::sin(0.05 * i)}),
        {0.5 * speed, 0, 0}};
    a = a * noisy(step);
    b = b * noisy(inverse(mount) * step * mount);
  }
  streams.T = to_dual_quaternion(mount);
  return streams;
}

TEST(OtherRows, StepsThatAreTurnedByAttitudesOfAnotherInstantAreNamed) {
  for (const auto& [part, words] : {std::pair<double, const char*>{1, "a row too late"},
                                    {0.5, "half a row too late"},
                                    {-0.5, "half a row too early"}})
    for (const char side : {'a', 'b'}) {
      const testing::Streams right = stop_and_go(1);
      testing::Streams wrong = right;
      Trajectory& stream = side == 'a' ? wrong.a : wrong.b;
      stream = with_turned_steps(stream, part);
      const Calibration calibration = calibrate(wrong.a, wrong.b);
      const Finding finding = certain_finding(calibration, std::string("axes_") + side);
      EXPECT_NE(finding.message.find(words), std::string::npos)
          << part << " of " << side << ": " << finding.message;
      expect_cured(right, calibration, finding, 0.005, 0.15);
    }
}

TEST(OtherRows, StepsAreNotCalledTurnedWhereTheyAreRightOrPositionsAreEarly) {
  for (const std::uint64_t seed : {1, 2}) {
    testing::Streams streams = stop_and_go(seed);
    const Calibration right = calibrate(streams.a, streams.b);
    EXPECT_EQ(right.verdict, Verdict::good) << right.reason;
    EXPECT_EQ(find(right, "axes_b"), nullptr);
    Trajectory early;
    for (std::size_t i = 0; i + 1 < streams.b.size(); ++i)
      early.push_back({streams.b[i].time_us,
                       canonical_sign(to_dual_quaternion(Pose{to_pose(streams.b[i].pose).rotation,
                                                              to_pose(streams.b[i + 1].pose).translation}))});
    const Calibration late = calibrate(streams.a, early);
    EXPECT_EQ(find(late, "axes_a"), nullptr) << late.reason;
    EXPECT_EQ(find(late, "axes_b"), nullptr) << late.reason;
    EXPECT_TRUE(find(late, "late_positions_b") != nullptr || find(late, "late_positions_a") != nullptr)
        << late.reason;
  }
}

/// With noise that hides it from the parts of the drive, but not from all together.
TEST(OtherRows, PositionsOfTheNextOrLastRowAreNamed) {
  for (const std::uint64_t seed : {1, 2, 3})
    for (const int later : {1, -1}) {
      testing::Streams right = stop_and_go(seed, 0.03);
      const Calibration as_it_is = calibrate(right.a, right.b);
      EXPECT_EQ(find(as_it_is, "late_positions_a"), nullptr) << as_it_is.reason;
      EXPECT_EQ(find(as_it_is, "late_positions_b"), nullptr) << as_it_is.reason;
      const Calibration found = calibrate(right.a, with_positions_of_row(right.b, later));
      const Finding *of_a = find(found, "late_positions_a"), *of_b = find(found, "late_positions_b");
      ASSERT_NE(of_b, nullptr) << seed << " " << later << " " << found.reason;
      const std::string said = of_b->message + (of_a ? of_a->message : "");
      EXPECT_NE(said.find("one row (0.5 s)"), std::string::npos) << seed << " " << later << " " << said;
      // what is late in one stream is early in the other one
      EXPECT_EQ(of_b->certain, of_a == nullptr) << seed << " " << later;
      EXPECT_EQ(found.verdict, Verdict::contradictory) << found.reason;
    }
}

}  // namespace
}  // namespace egocal::test_other_rows
