// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The page of a pair is made with all that the rig states of it.
#include "offline/rig/pair_request.hpp"

#include <gtest/gtest.h>

#include <string>

namespace egocal::tools::test_pair_request {
namespace {

bus::Rig rig_of(const std::string& more_of_camera, const std::string& more_of_pair) {
  return bus::parse_rig("[[sensor]]\nname = \"lidar\"\nchannel = \"LIDAR\"\nscale = 0.001\n" +
                            ("[[sensor]]\nname = \"camera\"\nchannel = \"CAMERA\"\n" + more_of_camera) +
                            "[[pair]]\na = \"lidar\"\nb = \"camera\"\n" + more_of_pair,
                        "a rig");
}

SolveRequest request_of(const bus::Rig& rig) {
  return request_of_pair(rig, rig.pairs.at(0), "drive.log");
}

TEST(PairRequest, NamesTheChannelsAndTheirScales) {
  const SolveRequest request = request_of(rig_of("", ""));
  EXPECT_EQ(request.source.log, "drive.log");
  EXPECT_EQ(request.source.a, "LIDAR");
  EXPECT_EQ(request.source.b, "CAMERA");
  EXPECT_EQ(request.calibration.read_a.scale, 0.001);
  EXPECT_FALSE(request.calibration.estimate_scale);
  EXPECT_FALSE(request.calibration.diagnosis.goal);
}

// The page called an answer contradictory that the processes had proven.
TEST(PairRequest, AScaleThatIsToBeFoundIsFound) {
  const SolveRequest request = request_of(rig_of("scale = \"auto\"\n", ""));
  EXPECT_TRUE(request.calibration.estimate_scale);
  EXPECT_EQ(request.calibration.scale_side, Side::b);
  EXPECT_EQ(request.scale_option, "--scale-b");
}

TEST(PairRequest, TheGoalIsThatOfTheRig) {
  const SolveRequest request =
      request_of(rig_of("", "platform = \"car\"\ngoal = { rotation_deg = 0.1, translation_m = 0.02 }\n"));
  ASSERT_TRUE(request.calibration.diagnosis.goal);
  EXPECT_EQ(request.calibration.diagnosis.platform, Platform::car);
}

}  // namespace
}  // namespace egocal::tools::test_pair_request
