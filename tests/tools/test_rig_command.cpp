// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve` with three sensors and more, and several drives, on simulated drives.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include "egocal/geometry/pose.hpp"
#include "rig_command.hpp"
#include "support/random_motion.hpp"

namespace egocal::test_rig_command {
namespace {

using nlohmann::json;
using testing::part_of;
using testing::words_of;

using RigOfFiles = testing::RigCommand;

/// A flat figure eight every five seconds, seen by three sensors on one body.
std::string figure_eights(const testing::ScratchFolder& folder) {
  testing::Random random(3);
  std::string files;
  for (const char* name : {"one", "two", "three"}) {
    const Pose mount{rotation_exp(random.normal3(0.3)), random.normal3(0.3)};
    std::ofstream file(folder.path(std::string(name) + ".tum"));
    file.precision(12);
    for (int i = 0; i < 1200; ++i) {
      const double phase = 2 * std::numbers::pi * i / 100;
      const Eigen::Vector3d place(3 * std::sin(phase), 1.5 * std::sin(2 * phase), 0);
      const double yaw = std::atan2(std::cos(2 * phase), std::cos(phase));
      const Pose pose = Pose{rotation_exp({0, 0, yaw}), place + random.normal3(1e-3)} * mount *
                        Pose{rotation_exp(random.normal3(1e-4)), Eigen::Vector3d::Zero()};
      const Eigen::Vector3d& t = pose.translation;
      const Rotation& q = pose.rotation;
      file << 1.7e9 + 0.05 * i << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' ' << q.y()
           << ' ' << q.z() << ' ' << q.w() << '\n';
    }
    files += " " + folder.path(std::string(name) + ".tum");
  }
  return files;
}

TEST_F(RigOfFiles, OffsetsOfARigThatRepeatsItsMotionAreOpen) {
  const std::string files = figure_eights(folder);
  const json found = run("solve --json --time-offset auto" + files).object();
  for (const json& extrinsic : found["extrinsics"]) {
    EXPECT_NE(extrinsic["verdict"], "good");
    EXPECT_NEAR(extrinsic["time_offset_s"].get<double>(), 0, 0.05);
    EXPECT_NE(extrinsic["findings"].dump().find("The motion repeats every "), std::string::npos)
        << extrinsic["findings"];
  }
  for (const json& extrinsic : run("solve --json" + files).object()["extrinsics"])
    EXPECT_EQ(extrinsic["findings"].dump().find("The motion repeats"), std::string::npos);
}

TEST_F(RigOfFiles, ARigOfThreeClosesItsLoopAndIsCertified) {
  const Result result = run("solve --json" + rig("drive"));
  ASSERT_EQ(result.code, 0) << result.error;
  const json object = result.object();
  ASSERT_EQ(object["extrinsics"].size(), 3u);
  std::set<std::string> pairs;
  for (const json& extrinsic : object["extrinsics"]) {
    pairs.insert(extrinsic["a"].get<std::string>() + " " + extrinsic["b"].get<std::string>());
    EXPECT_TRUE(extrinsic["certified"]);
    EXPECT_EQ(extrinsic["verdict"], "good");
  }
  EXPECT_EQ(pairs, (std::set<std::string>{"lidar camera", "lidar radar", "camera radar"}));
  ASSERT_EQ(object["loops"].size(), 1u);
  EXPECT_TRUE(object["loops"][0]["closed"]);
  EXPECT_LT(object["loops"][0]["rotation_deg"], 0.02);
  EXPECT_LT(object["loops"][0]["translation_m"], 0.005);
  EXPECT_TRUE(object["joint"]["certified"]);
  EXPECT_TRUE(object["blamed"].is_null());
  for (const json& finding : object["findings"]) EXPECT_FALSE(finding["certain"]) << finding;
  // the mounts of the simulation
  const json& tree = object["joint"]["tree"];
  ASSERT_EQ(tree.size(), 2u);
  const double expected[2][3] = {{1.5, 0.2, -0.3}, {2, 0, -1.3}};
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(tree[k]["translation"][i].get<double>(), expected[k][i], 0.05);
}

TEST_F(RigOfFiles, APairsAnswerIsThatOfItsTwoStreamsAlone) {
  // the third sensor was on for three seconds: all three share next to nothing
  const std::vector<std::string> files = words_of(rig("drive"));
  const std::string shortened = part_of(folder, files[2], "short.tum", 0, 3);
  const std::string two = files[0] + " " + files[1];
  const json alone = run("solve --json " + two).object();
  const Result whole = run("solve --json " + two + " " + shortened);
  const json object = whole.object();
  const json& pair = object["extrinsics"][0];
  for (const char* key : {"translation", "rotation_wxyz", "stddev", "cost"})
    EXPECT_EQ(pair[key], alone[key]) << key;
  EXPECT_EQ(pair["verdict"], "good");
  // and the tree is that answer, with what it states
  EXPECT_EQ(object["joint"]["source"], "pairs");
  EXPECT_FALSE(object["joint"]["reason"].get<std::string>().empty());
  bool found = false;
  for (const json& edge : object["joint"]["tree"]) {
    if (edge["child"] != pair["b"] || edge["parent"] != pair["a"]) continue;
    found = true;
    EXPECT_EQ(edge["translation"], pair["translation"]);
    EXPECT_EQ(edge["stddev"], pair["stddev"]);
    EXPECT_EQ(edge["verdict"], pair["verdict"]);
  }
  EXPECT_TRUE(found);
  // a loop that nobody knows is neither open nor closed
  ASSERT_EQ(object["loops"].size(), 1u);
  EXPECT_EQ(object["loops"][0]["known_directions"], 0);
  EXPECT_TRUE(object["loops"][0]["closed"].is_null());
  EXPECT_NE(run("solve " + two + " " + shortened).out.find(": unknown"), std::string::npos);
}

TEST_F(RigOfFiles, AnotherDriveOfTheRigAddsUp) {
  const std::string one = rig("one", "--seed 1", 300), two = rig("two", "--seed 2", 300);
  const json single = run("solve --json" + one).object();
  std::string append;
  std::istringstream files(two);
  for (std::string file; files >> file;) append += " " + file;
  const Result result = run("solve --json" + one + " --append" + append);
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_GT(result.object()["extrinsics"][0]["pairs"], 1.8 * single["extrinsics"][0]["pairs"].get<double>());
}

}  // namespace
}  // namespace egocal::test_rig_command
