// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Rotations that belong to other times than the positions of the same stream, shown by few turns.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "../support/findings.hpp"
#include "../support/steered_part.hpp"
#include "diagnosis/explanations/times/early_rotations.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/evaluation/errors.hpp"

namespace egocal::test_early_rotations {
namespace {

using testing::find;
using testing::on_a_steered_part;

/// A minute on rough ground, at speeds that vary.
testing::Streams drive_of_speeds(std::uint64_t seed) {
  SimulationOptions options;
  options.terrain = Terrain::rough;
  options.poses = 601;
  options.relative_noise = 0.003;
  options.speed_variation = 0.7;
  options.seed = seed;
  return testing::simulated_drive(options);
}

detail::EarlyRotations seen(const testing::Streams& streams, Side side) {
  const DiagnosisOptions options;
  const detail::Evidence evidence = detail::gather(streams.a, streams.b, {}, 0.5, options);
  const std::optional<detail::EarlyRotations> found =
      detail::early_rotations(evidence.instants, evidence.given.explained, side);
  EXPECT_TRUE(found);
  return found.value_or(detail::EarlyRotations{});
}

TEST(EarlyRotations, AreNotThoseOfRightStreams) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
      for (const Side side : {Side::a, Side::b})
        EXPECT_LT(seen(testing::drive(terrain, seed), side).sigmas(), 3.5) << seed;
}

TEST(EarlyRotations, HaveTheTimeOfAPartThatIsSteered) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    testing::Streams streams = drive_of_speeds(seed);
    EXPECT_LT(seen(streams, Side::b).sigmas(), 3.5) << seed;
    streams.b = on_a_steered_part(streams.b, 0.2);
    const detail::EarlyRotations found = seen(streams, Side::b);
    EXPECT_NEAR(found.seconds, 0.2, 0.06) << seed;
    EXPECT_GT(found.sigmas(), 3.5) << seed;
    EXPECT_LT(extrinsic_error(streams.T, found.T_a_b).translation,
              0.5 * extrinsic_error(streams.T, found.T_a_b_as_given).translation)
        << seed;
  }
}

TEST(EarlyRotations, AreNotAClockThatDiffers) {
  testing::Streams streams = drive_of_speeds(1);
  for (StampedPose& pose : streams.b) pose.time_us += 50'000;
  const detail::EarlyRotations found = seen(streams, Side::b);
  EXPECT_GT(std::abs(found.of_rotations), 0.03);
  EXPECT_LT(std::abs(found.seconds), 0.5 * std::abs(found.of_rotations));
}

// There another time of the positions is another lever arm: up to 8 standard deviations of nothing.
TEST(EarlyRotations, AreNotAClockThatDiffersAtOneSpeed) {
  SimulationOptions options;
  options.terrain = Terrain::rough;
  options.poses = 401;
  options.rate = 3;
  options.roughness = 0.1;
  options.relative_noise = 0.003;
  for (const double offset : {0.04, 0.08}) {
    options.faults.resize(2);
    options.faults[1].clock_offset = offset;
    const testing::Streams streams = testing::simulated_drive(options);
    const detail::EarlyRotations found = seen(streams, Side::b);
    EXPECT_GT(found.sigmas(), 3.5) << "not by the standard deviations alone";
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_EQ(find(calibration, "late_positions_b"), nullptr);
    EXPECT_NE(find(calibration, "clock_offset"), nullptr) << offset;
  }
}

// Which stream it is, and whether its mounting or a filter turns it, the motions cannot tell.
TEST(EarlyRotations, AreNamedWithBothReadings) {
  for (const std::uint64_t seed : {1, 3}) {
    testing::Streams streams = drive_of_speeds(seed);
    EXPECT_EQ(find(calibrate(streams.a, streams.b), "late_positions_b"), nullptr);
    streams.b = on_a_steered_part(streams.b, 0.2);
    const Calibration calibration = calibrate(streams.a, streams.b);
    EXPECT_GE(calibration.verdict, Verdict::doubtful) << calibration.reason;
    const Finding* finding = find(calibration, "late_positions_b");
    ASSERT_NE(finding, nullptr) << calibration.reason;
    EXPECT_NE(find(calibration, "mount_moved"), nullptr) << calibration.reason;
  }
}

}  // namespace
}  // namespace egocal::test_early_rotations
