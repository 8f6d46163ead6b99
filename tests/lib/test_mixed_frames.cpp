// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Streams whose poses are of two frames of the same body in turn, as of two publishers on one topic.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "../support/findings.hpp"
#include "../support/mistakes.hpp"
#include "../support/random_motion.hpp"
#include "egocal/calibrate.hpp"

namespace egocal::test_mixed_frames {
namespace {

/// Every n-th pose is of another frame, which is at `other` in the right one.
Trajectory mixed(Trajectory trajectory, std::size_t n, const Pose& other) {
  for (std::size_t i = 0; i < trajectory.size(); i += n)
    trajectory[i].pose = canonical_sign(trajectory[i].pose * to_dual_quaternion(other));
  return trajectory;
}

bool names_mixed_frames(const Calibration& calibration) {
  return testing::find(calibration, "mixed_frames_a") || testing::find(calibration, "mixed_frames_b");
}

TEST(MixedFrames, AreNamedWithTheirStream) {
  const Pose apart{Rotation::Identity(), {1, 0.3, 0}},
      turned{rotation_exp({0, 0, 0.07}), Eigen::Vector3d::Zero()};
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const std::size_t n : {2, 3})
      for (const Pose& other : {apart, turned})
        for (const char side : {'a', 'b'}) {
          testing::Streams streams = testing::drive(terrain);
          Trajectory& wrong = side == 'a' ? streams.a : streams.b;
          wrong = mixed(std::move(wrong), n, other);
          const Calibration calibration = calibrate(streams.a, streams.b);
          const Finding* finding = testing::find(calibration, std::string("mixed_frames_") + side);
          ASSERT_NE(finding, nullptr) << n << side << ": " << calibration.reason;
          EXPECT_TRUE(finding->certain);
          EXPECT_EQ(calibration.verdict, Verdict::contradictory);
        }
}

/// Of poses single steps hold the noise of both ends, as long motions do.
TEST(MixedFrames, NoiseOnPosesIsNoOtherFrame) {
  for (const double noise : {0.001, 0.01, 0.1})
    for (const std::uint64_t seed : {1, 2, 3}) {
      testing::Streams streams = testing::drive(Terrain::rough, seed);
      testing::Random random(seed);
      for (Trajectory* stream : {&streams.a, &streams.b})
        for (auto& stamped : *stream)
          stamped.pose =
              canonical_sign(stamped.pose * to_dual_quaternion({rotation_exp(random.normal3(0.1 * noise)),
                                                                random.normal3(noise)}));
      EXPECT_FALSE(names_mixed_frames(calibrate(streams.a, streams.b))) << noise << " " << seed;
    }
}

/// Single steps leave a part of the way then.
TEST(MixedFrames, StampsThatAlternateAndHeldValuesAreNoOtherFrame) {
  for (const Terrain terrain : {Terrain::rough, Terrain::free}) {
    testing::Streams late = testing::drive(terrain);
    for (std::size_t i = 0; i < late.b.size(); i += 2) late.b[i].time_us += 40'000;
    const Calibration of_late = calibrate(late.a, late.b);
    for (const Finding& finding : of_late.findings)
      EXPECT_FALSE(finding.certain && finding.code.starts_with("mixed_frames_")) << finding.message;
    EXPECT_NE(of_late.verdict, Verdict::contradictory) << of_late.reason;
    for (const std::size_t n : {2, 3}) {
      const testing::Streams right = testing::drive(terrain);
      for (const Trajectory& held :
           {testing::with_held_positions(right.b, n), testing::with_held_rotations(right.b, n)})
        EXPECT_FALSE(names_mixed_frames(calibrate(right.a, held))) << n;
    }
  }
}

/// A slow stream that is interpolated at the stamps of a fast one.
TEST(MixedFrames, ASlowStreamIsNoneOfTwoFrames) {
  for (const std::size_t slower : {2, 3, 5}) {
    const testing::Streams streams = testing::drive(Terrain::rough);
    Trajectory slow;
    for (std::size_t i = 0; i < streams.b.size(); i += slower) slow.push_back(streams.b[i]);
    EXPECT_FALSE(names_mixed_frames(calibrate(streams.a, slow))) << slower;
    EXPECT_FALSE(names_mixed_frames(calibrate(slow, streams.a))) << slower;
  }
}

}  // namespace
}  // namespace egocal::test_mixed_frames
