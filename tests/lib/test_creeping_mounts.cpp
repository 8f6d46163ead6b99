// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A mount that bends slowly is weighed against other explanations with the mounting of each part of its way.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "../support/findings.hpp"
#include "../support/simulated_drive.hpp"
#include "../support/tractor.hpp"
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

// It was compared as one mounting for the whole drive, which explains nothing: anything else was named then.
TEST(CreepingMount, ExplainsMoreThanOneMounting) {
  const testing::Streams streams = testing::tractor(1, 0.05);
  const DiagnosisOptions options;
  const detail::Evidence evidence =
      detail::gather(streams.a, streams.b, {}, PairingOptions().max_gap, options);
  EXPECT_GT(detail::gain_of_parts(evidence, {move_at(0, MountingChange::slowly)}, options), 0.5);
  const testing::Streams still = testing::tractor(1, 0);
  const detail::Evidence of_still = detail::gather(still.a, still.b, {}, PairingOptions().max_gap, options);
  EXPECT_LT(detail::gain_of_parts(of_still, {move_at(0, MountingChange::slowly)}, options),
            options.least_gain);
}

TEST(CreepingMount, IsNamed) {
  const testing::Streams streams = testing::tractor(1, 0.05);
  const Calibration calibration = calibrate(streams.a, streams.b);
  const Finding* moved = testing::find(calibration, "mount_moved");
  ASSERT_NE(moved, nullptr) << calibration.reason;
  EXPECT_EQ(moved->change, MountingChange::slowly) << moved->message;
  EXPECT_EQ(testing::find(calibration, "axes_both"), nullptr);
}

}  // namespace
}  // namespace egocal::test_creeping_mounts
