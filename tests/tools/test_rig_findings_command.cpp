// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve` with three sensors: what is found of them, and which one is blamed.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "egocal/io/trajectory_file.hpp"
#include "rig_command.hpp"
#include "support/mistakes.hpp"
#include "support/random_motion.hpp"

namespace egocal::test_rig_findings_command {
namespace {

using nlohmann::json;
using testing::part_of;
using testing::words_of;

using RigOfFiles = testing::RigCommand;

/// Two odometries of one frame, such as two of one lidar: right, or both were moved to it before.
TEST_F(RigOfFiles, WhatIsPossibleIsShownAndBlamesNobody) {
  const std::vector<std::string> files = words_of(rig("drive"));
  std::ifstream given(files[0]);
  const std::string other = folder.path("other.tum");
  std::ofstream out(other);
  testing::Random random(5);
  for (std::string line; std::getline(given, line);) {
    std::istringstream row(line);
    std::string time, quaternion;
    Eigen::Vector3d place;
    if (!(row >> time >> place.x() >> place.y() >> place.z())) continue;
    std::getline(row, quaternion);
    place += random.normal3(0.002);
    out << time << " " << place.transpose() << quaternion << "\n";
  }
  out.close();
  const std::string command = "solve " + files[0] + " " + files[1] + " " + other;
  const Result result = run(command + " --json");
  EXPECT_EQ(result.code, 0) << result.error;
  const json object = result.object();
  std::set<std::string> codes;
  for (const json& finding : object["findings"]) {
    codes.insert(finding["code"].get<std::string>());
    EXPECT_FALSE(finding["certain"]) << finding;
  }
  EXPECT_TRUE(codes.contains("same_stream")) << object["findings"];
  EXPECT_TRUE(object["blamed"].is_null());
  EXPECT_NE(run(command).out.find("possible      "), std::string::npos);
}

/// 3 as documented: a stream that makes a pair doubtful is in every extrinsic of the consistent set. Two
/// sensors that are doubtful end with 0.
TEST_F(RigOfFiles, AFindingThatMakesAPairDoubtfulEndsWithThree) {
  const std::vector<std::string> files = words_of(rig("drive"));
  const std::string copy = part_of(folder, files[0], "copy.tum", 0, 1e9);
  const Result result = run("solve --json " + files[0] + " " + files[1] + " " + copy);
  EXPECT_EQ(result.code, 3) << result.error;
  EXPECT_EQ(result.object()["findings"][0]["code"], "same_stream");
  EXPECT_TRUE(result.object()["blamed"].is_null());
  const Result two = run("solve --json " + files[0] + " " + copy);
  EXPECT_EQ(two.code, 0);
  EXPECT_EQ(two.object()["verdict"], "doubtful");
  std::string help = run("--help").out;
  std::replace(help.begin(), help.end(), '\n', ' ');
  EXPECT_NE(help.find("a finding makes a pair doubtful"), std::string::npos) << help;
}

// The lidar, which both pairs have in common, was blamed.
TEST_F(RigOfFiles, AWrongNominalValueBlamesNoSensor) {
  const std::vector<std::string> files = words_of(rig("flat", "", 700, "flat"));
  const std::string of_rig = folder.path("rig.toml");
  std::ofstream out(of_rig);
  std::string from;
  const char* names[] = {"lidar", "camera", "radar"};
  for (std::size_t k = 0; k < 3; ++k) {
    out << "[[sensor]]\nname = \"" << names[k] << "\"\nchannel = \"" << names[k] << "\"\n";
    from += std::string(" --from ") + names[k] + "=" + files[k];
  }
  const char* in_millimetres[] = {"1500, 200, -300, 0.5, -0.5, 0.5, -0.5", "2000, 0, -1300, 1, 0, 0, 0"};
  for (std::size_t k = 0; k < 2; ++k)
    out << "[[pair]]\na = \"lidar\"\nb = \"" << names[k + 1] << "\"\nnominal = [" << in_millimetres[k]
        << "]\n";
  out.close();
  const Result result = run("solve --json --rig " + of_rig + from);
  EXPECT_EQ(result.code, 3) << "z is taken from them: " << result.error;
  const json object = result.object();
  EXPECT_TRUE(object["blamed"].is_null()) << object["blamed"];
  std::vector<std::string> messages;
  for (const json& finding : object["findings"]) {
    if (finding["code"] != "nominal") continue;
    EXPECT_TRUE(finding["sensor"].is_null()) << finding;
    messages.push_back(finding["message"]);
  }
  EXPECT_THAT(messages, ::testing::ElementsAre(::testing::StartsWith("lidar, camera: The nominal value is "),
                                               ::testing::StartsWith("lidar, radar: The nominal value is ")));
}

TEST_F(RigOfFiles, ASensorThatIsWrongIsNamed) {
  const struct {
    const char* fault;
    const char* code;
    const char* sensor;
    const char* terrain = "free";
  } cases[] = {{"--bump camera=60:0.02,0,0,0,0,1", "mount_moved", "camera"},
               {"--bump radar=50:0,0,0,1,0,0", "mount_moved", "radar", "rough"},
               {"--clock-offset radar=0.05", "clock_offset", "radar"},
               {"--scale camera=2", "scale", "camera"}};
  for (const auto& wrong : cases) {
    const Result result = run("solve --json" + rig("wrong", wrong.fault, 1200, wrong.terrain));
    EXPECT_EQ(result.code, 3) << wrong.fault;
    const json object = result.object();
    EXPECT_EQ(object["blamed"], wrong.sensor) << wrong.fault;
    ASSERT_FALSE(object["findings"].empty()) << wrong.fault;
    EXPECT_EQ(object["findings"][0]["code"], wrong.code) << wrong.fault;
    EXPECT_EQ(object["findings"][0]["sensor"], wrong.sensor) << wrong.fault;
  }
}

// Each pair of the camera names either of its sensors; the camera is the one that both may mean.
TEST_F(RigOfFiles, WhereBothPairsNameEitherSensorTheCommonOneIsBlamed) {
  const std::string files = rig("turns", "--roughness 0.3", 1200, "rough");
  const std::string camera = folder.path("turns") + "/camera.tum";
  write_tum(camera, testing::with_turning_scale(read_trajectory(camera), 0.97));
  const Result result = run("solve --json" + files);
  EXPECT_EQ(result.code, 3);
  const json object = result.object();
  EXPECT_EQ(object["blamed"], "camera");
  const auto turning = std::find_if(object["findings"].begin(), object["findings"].end(),
                                    [](const json& one) { return one["code"] == "turning_scale"; });
  ASSERT_NE(turning, object["findings"].end()) << object["findings"];
  EXPECT_EQ((*turning)["sensor"], "camera");
  EXPECT_THAT((*turning)["remedy"].get<std::string>(), ::testing::HasSubstr("camera"));
}

// Each pair of the radar says that either of its sensors may have the late positions, and is uncertain.
TEST_F(RigOfFiles, LatePositionsOfEitherSensorAreThoseOfTheCommonOne) {
  const std::string files = rig("late", "--speed-variation 0.4", 900, "rough");
  const std::string radar = folder.path("late") + "/radar.tum";
  write_tum(radar, testing::with_late_positions(read_trajectory(radar), 3));
  const Result result = run("solve --json" + files);
  EXPECT_EQ(result.code, 3);
  const json object = result.object();
  EXPECT_EQ(object["blamed"], "radar");
  ASSERT_FALSE(object["findings"].empty());
  const json& finding = object["findings"][0];
  EXPECT_EQ(finding["code"], "late_positions");
  EXPECT_EQ(finding["sensor"], "radar");
  EXPECT_EQ(finding["certain"], true);
}

TEST_F(RigOfFiles, ARelocalisationIsNoMovedMount) {
  const Result result = run("solve --json" + rig("jump", "--jump camera=40:0.5,0,0,0,0,5", 1200));
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.object()["blamed"].is_null());
}

}  // namespace
}  // namespace egocal::test_rig_findings_command
