// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mount that bends slowly is weighed against other explanations with the mounting of each part of its way.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "../support/findings.hpp"
#include "../support/random_motion.hpp"
#include "../support/shaken_car.hpp"
#include "../support/simulated_drive.hpp"
#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/explanations/lengths/not_a_move.hpp"
#include "diagnosis/mount/in_parts.hpp"
#include "egocal/calibrate.hpp"
#include "egocal/pairing/options.hpp"

namespace egocal::test_creeping_mounts {
namespace {

detail::Motions motions_at_seconds(std::size_t count) {
  detail::Motions motions;
  motions.all.resize(count);
  for (std::size_t i = 0; i < count; ++i) motions.all[i].time = static_cast<double>(i) + 0.5;
  return motions;
}

Finding move_at(double time, MountingChange change) {
  Finding finding;
  finding.code = "mount_moved";
  finding.time = time;
  finding.change = change;
  return finding;
}

TEST(CreepingMount, IsDividedIntoPartsUntilTheNextMove) {
  using Bounds = std::vector<std::size_t>;
  const detail::Motions motions = motions_at_seconds(40);
  const auto bounds = [&](const std::vector<Finding>& moves) {
    return detail::bounds_of_parts(motions, moves);
  };
  EXPECT_EQ(bounds({}), (Bounds{0, 40}));
  EXPECT_EQ(bounds({move_at(10, MountingChange::at_once)}), (Bounds{0, 10, 40}));
  EXPECT_EQ(bounds({move_at(0, MountingChange::slowly)}), (Bounds{0, 10, 20, 30, 40}));
  EXPECT_EQ(bounds({move_at(4, MountingChange::slowly), move_at(24, MountingChange::at_once)}),
            (Bounds{0, 4, 9, 14, 19, 24, 40}));
  EXPECT_EQ(detail::bounds_of_parts(motions_at_seconds(2), {move_at(0, MountingChange::slowly)}),
            (Bounds{0, 1, 2}));
}

/// A tractor in rows of 33 s, four minutes at 10 Hz, with little noise. The mount of b bends by `bent` [rad],
/// half of it in the first quarter.
testing::Streams tractor(std::uint64_t seed, double bent) {
  constexpr double period = 0.1, seconds = 240;
  testing::Random random(seed);
  const testing::Shaking roll(random, 0.2, 1, 0.03), pitch(random, 0.2, 1, 0.03),
      slope(random, 0.01, 0.05, 0.04);
  const DualQuaternion T_a = testing::displacement(random.normal3(1), random.normal3(0.03)),
                       T_b = testing::displacement(random.normal3(1), random.normal3(0.03));
  const Eigen::Vector3d axis = random.direction();
  testing::Streams streams;
  streams.T = conjugate(T_a) * T_b;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  double heading = 0;
  for (int i = 0; i < static_cast<int>(seconds / period); ++i) {
    const double t = period * i, in_row = std::fmod(t, 40.0), side = std::fmod(t, 80.0) < 40 ? 1 : -1;
    if (in_row > 33)
      heading += side * period * 0.45 * (1 - std::cos(2 * std::numbers::pi * (in_row - 33) / 7));
    const double up = slope.at(t);
    place += 2.2 * period * Eigen::Vector3d(std::cos(heading), std::sin(heading), -up);
    const DualQuaternion body = testing::displacement({0, 0, heading}, place) *
                                testing::displacement({0, pitch.at(t) + up, 0}, {0, 0, 0}) *
                                testing::displacement({roll.at(t), 0, 0}, {0, 0, 0});
    const DualQuaternion bend =
        testing::displacement(bent * (1 - std::exp2(-4 * t / seconds)) * axis, {0, 0, 0});
    const auto measured = [&](const DualQuaternion& T) {
      return canonical_sign(
          normalized(body * T * testing::displacement(random.normal3(1e-4), random.normal3(2e-3))));
    };
    const auto time_us = std::int64_t{100'000} * i;
    streams.a.push_back({time_us, measured(T_a)});
    streams.b.push_back({time_us, measured(T_b * bend)});
  }
  return streams;
}

// It was compared as one mounting for the whole drive, which explains nothing: anything else was named then.
TEST(CreepingMount, ExplainsMoreThanOneMounting) {
  const testing::Streams streams = tractor(1, 0.05);
  const DiagnosisOptions options;
  const detail::Evidence evidence =
      detail::gather(streams.a, streams.b, {}, PairingOptions().max_gap, options);
  EXPECT_GT(detail::gain_of_parts(evidence, {move_at(0, MountingChange::slowly)}, options), 0.5);
  const testing::Streams still = tractor(1, 0);
  const detail::Evidence of_still = detail::gather(still.a, still.b, {}, PairingOptions().max_gap, options);
  EXPECT_LT(detail::gain_of_parts(of_still, {move_at(0, MountingChange::slowly)}, options),
            options.least_gain);
}

TEST(CreepingMount, IsNamed) {
  const testing::Streams streams = tractor(1, 0.05);
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* moved = testing::find(calibration, "mount_moved");
  ASSERT_NE(moved, nullptr) << calibration.reason;
  EXPECT_EQ(moved->change, MountingChange::slowly) << moved->message;
  EXPECT_EQ(testing::find(calibration, "axes_both"), nullptr);
}

}  // namespace
}  // namespace egocal::test_creeping_mounts
