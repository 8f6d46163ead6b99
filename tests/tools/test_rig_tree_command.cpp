// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve` with three sensors: one consistent set, as a tree.
#include <gmock/gmock.h>

#include <sstream>

#include "rig_command.hpp"

namespace egocal::test_rig_tree_command {
namespace {

using nlohmann::json;
using testing::content_of;
using testing::part_of;
using testing::words_of;

using RigOfFiles = testing::RigCommand;

TEST_F(RigOfFiles, TheJointAnswerStatesItsOwnSpread) {
  const json object = run("solve --json" + rig("drive")).object();
  EXPECT_EQ(object["joint"]["source"], "joint");
  for (std::size_t k = 0; k < 2; ++k) {
    const json &edge = object["joint"]["tree"][k], &pair = object["extrinsics"][k];
    EXPECT_EQ(edge["verdict"], "good");
    EXPECT_NE(edge["stddev"], pair["stddev"]);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_GT(edge["stddev"][i], 0);
      EXPECT_LT(edge["stddev"][i].get<double>(), 3 * pair["stddev"][i].get<double>());
    }
  }
}

TEST_F(RigOfFiles, TheConsistentSetIsWrittenAsOneTree) {
  const std::string files = rig("drive", "", 300), urdf = folder.path("rig.urdf");
  ASSERT_EQ(run("solve" + files + " --format urdf --out " + urdf).code, 0);
  const std::string text = content_of(urdf);
  for (const char* part : {"<robot", "lidar_to_camera", "lidar_to_radar", "</robot>"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  const Result ros = run("solve" + files + " --format ros");
  EXPECT_EQ(ros.code, 0);
  EXPECT_NE(ros.out.find("--child-frame-id radar"), std::string::npos);
  // a format of one extrinsic: nothing is written
  const Result kalibr = run("solve" + files + " --format kalibr --out " + folder.path("none"));
  EXPECT_EQ(kalibr.code, 2) << "known before anything is read";
  EXPECT_NE(kalibr.error.find("--format kalibr: holds one extrinsic"), std::string::npos) << kalibr.error;
  EXPECT_TRUE(content_of(folder.path("none")).empty());
}

/// The line above the joint of a child in a URDF: what is said of it.
std::string said_of(const std::string& child, const std::string& urdf) {
  std::string line, said;
  for (std::istringstream lines(urdf); std::getline(lines, line);) {
    if (line.find("<joint ") != std::string::npos && line.find("_to_" + child + "\"") != std::string::npos)
      return said;
    if (line.starts_with("<!-- ")) said = line;
  }
  return "no joint of " + child;
}

// Every edge said DO NOT USE, whatever the contradictory pair had to do with it.
TEST_F(RigOfFiles, WhatAContradictoryPairDoesNotBearOnIsNotMarked) {
  for (const char* wrong : {"camera", "radar"}) {
    const std::string other = wrong == std::string("camera") ? "radar" : "camera";
    const std::string files = rig("wrong", std::string("--scale ") + wrong + "=2", 700);
    const Result result = run("solve" + files + " --format urdf");
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(said_of(wrong, result.out), ::testing::HasSubstr("DO NOT USE"));
    EXPECT_THAT(said_of(other, result.out), ::testing::StartsWith("<!-- verdict good"));
    EXPECT_THAT(result.error, ::testing::HasSubstr("Do not use those of the tree that are marked."));
    const json tree = run("solve --json" + files).object()["joint"]["tree"];
    for (const json& edge : tree)
      EXPECT_EQ(edge["verdict"], edge["child"] == other ? "good" : "contradictory") << edge;
  }
}

// A pair that should not be used is no edge where the others connect all sensors.
TEST_F(RigOfFiles, TheTreeDoesWithoutAPairThatShouldNotBeUsed) {
  const std::vector<std::string> files = words_of(rig("drive"));
  const std::string copy = part_of(folder, files[0], "copy.tum", 0, 1e9);
  const Result result = run("solve " + files[0] + " " + files[1] + " " + copy + " --format urdf");
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.out.find("DO NOT USE"), std::string::npos) << result.out;
  EXPECT_THAT(result.error, ::testing::HasSubstr("It bears on no extrinsic of the tree."));
}

}  // namespace
}  // namespace egocal::test_rig_tree_command
