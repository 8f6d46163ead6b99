// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve` with three sensors and more, and several drives, on simulated drives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include "egocal/geometry/pose.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "rig_command.hpp"
#include "support/mistakes.hpp"
#include "support/random_motion.hpp"

namespace egocal::test_rig_command {
namespace {

using nlohmann::json;
using testing::content_of;
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

/// Of a file of poses, those from one time to another [s] from its begin.
std::string part_of(const testing::ScratchFolder& folder, const std::string& file, const std::string& name,
                    double from, double to) {
  std::ifstream all(file);
  std::ofstream part(folder.path(name));
  double begin = -1;
  for (std::string line; std::getline(all, line);) {
    if (line.empty() || line[0] == '#') continue;
    const double time = std::stod(line);
    if (begin < 0) begin = time;
    if (time - begin >= from && time - begin <= to) part << line << "\n";
  }
  return folder.path(name);
}

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

TEST_F(RigOfFiles, TwoSensorsThatShareNoTimeLeaveTheOthers) {
  const std::vector<std::string> files = words_of(rig("drive"));
  const std::string first = part_of(folder, files[0], "first.tum", 0, 30),
                    last = part_of(folder, files[2], "last.tum", 35, 70);
  const Result result = run("solve --json " + first + " " + files[1] + " " + last);
  ASSERT_EQ(result.code, 0) << result.error;
  const json object = result.object();
  EXPECT_EQ(object["extrinsics"].size(), 2u);
  ASSERT_EQ(object["unsolved"].size(), 1u);
  EXPECT_EQ(object["unsolved"][0]["a"], "first");
  EXPECT_EQ(object["unsolved"][0]["b"], "last");
  EXPECT_NE(object["unsolved"][0]["reason"].get<std::string>().find("first: "), std::string::npos)
      << "sensors by name, not a and b: " << object["unsolved"][0]["reason"];
  EXPECT_EQ(object["joint"]["tree"].size(), 2u);
  // without the one that connects them
  const Result apart = run("solve --json " + first + " " + last + " " + last);
  EXPECT_EQ(apart.code, 3);
  EXPECT_NE(apart.error.find("first"), std::string::npos) << apart.error;
  EXPECT_EQ(apart.object()["joint"]["apart"], json::array({first}));
  // no pair has an answer
  const std::string middle = part_of(folder, files[1], "middle.tum", 31, 34);
  const Result none = run("solve " + first + " " + middle + " " + last);
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.error.find("first, middle: no motion pairs"), std::string::npos) << none.error;
}

// It ended with an error, without the answers of the others.
TEST_F(RigOfFiles, ASensorThatIsFrozenLeavesTheOthers) {
  const std::vector<std::string> files = words_of(rig("drive"));
  for (std::size_t frozen = 0; frozen < 3; ++frozen) {
    std::vector<std::string> three = files;
    three[frozen] = folder.path("frozen.tum");
    std::ifstream moving(files[frozen]);
    std::ofstream still(three[frozen]);
    for (std::string line; std::getline(moving, line);)
      if (!line.starts_with('#')) still << line.substr(0, line.find(' ')) << " 1 2 3 0 0 0 1\n";
    still.close();
    const std::string names = three[0] + " " + three[1] + " " + three[2];
    const Result result = run("solve --json " + names);
    EXPECT_EQ(result.code, 3) << "a sensor has no answer: " << result.error;
    const json object = result.object();
    EXPECT_EQ(object["unsolved"].size(), 2u);
    for (const json& pair : object["unsolved"]) {
      EXPECT_TRUE(pair["a"] == "frozen" || pair["b"] == "frozen") << pair;
      EXPECT_NE(pair["reason"].get<std::string>().find("the poses of frozen are all the same"),
                std::string::npos)
          << pair;
    }
    ASSERT_EQ(object["extrinsics"].size(), 1u);
    EXPECT_EQ(object["extrinsics"][0]["verdict"], "good");
    EXPECT_EQ(object["joint"]["apart"], json::array({"frozen"}));
    EXPECT_EQ(object["joint"]["tree"].size(), 1u);
    const Result offset = run("solve --json --time-offset auto " + names);
    EXPECT_EQ(offset.code, 3) << offset.error;
    EXPECT_EQ(offset.object()["extrinsics"].size(), 1u);
    EXPECT_EQ(offset.object()["joint"]["apart"], json::array({"frozen"}));
    for (const json& pair : offset.object()["unsolved"])
      EXPECT_NE(pair["reason"].get<std::string>().find("the poses of frozen are all the same"),
                std::string::npos)
          << pair;
    const Result printed = run("solve " + names);
    EXPECT_EQ(printed.code, 3);
    EXPECT_NE(printed.out.find("not in it, without an answer that connects them: frozen\n"),
              std::string::npos)
        << printed.out;
    const Result written = run("solve " + names + " --format urdf");
    EXPECT_EQ(written.code, 3);
    EXPECT_EQ(written.out.find("frozen"), std::string::npos);
    EXPECT_NE(written.error.find("not in the tree, as no answer connects them with the others: frozen"),
              std::string::npos)
        << written.error;
  }
}

// The cure was what had been tried: --time-offset auto.
TEST_F(RigOfFiles, AnOffsetThatIsNotFoundIsTheReason) {
  const std::vector<std::string> files = words_of(rig("drive"));
  const std::string other = folder.path("other.tum");  // of another epoch, and too short
  std::ifstream given(part_of(folder, files[2], "short.tum", 0, 3));
  std::ofstream out(other);
  for (std::string line; std::getline(given, line);)
    out << std::to_string(std::stod(line) - 1e6) << line.substr(line.find(' ')) << "\n";
  out.close();
  const Result result = run("solve --json --time-offset auto " + files[0] + " " + files[1] + " " + other);
  EXPECT_EQ(result.code, 3) << result.error;
  const json unsolved = result.object()["unsolved"];
  EXPECT_EQ(unsolved.size(), 2u);
  for (const json& pair : unsolved)
    EXPECT_THAT(pair["reason"].get<std::string>(),
                ::testing::StartsWith("time offset: cannot be estimated, the streams are too short"));
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
  EXPECT_NE(kalibr.code, 0);
  EXPECT_TRUE(content_of(folder.path("none")).empty());
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
