// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve` with three sensors and more, unknown scale and several drives: the program itself on
// simulated drives.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "support/paths.hpp"
#include "support/random_motion.hpp"
#include "support/scratch_folder.hpp"

namespace egocal {
namespace {

using nlohmann::json;

std::string content_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

class Command : public ::testing::Test {
 protected:
  struct Result {
    int code = -1;
    std::string out, error;
    json object() const { return json::parse(out); }
  };
  Result run(const std::string& arguments) {
    const std::string out = folder.path("out"), error = folder.path("err");
    const int status =
        std::system((paths::bin_dir() + "/egocal " + arguments + " >" + out + " 2>" + error).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(out), content_of(error)};
  }
  /// lidar, camera and radar in free motion; their three files.
  std::string rig(const std::string& name, const std::string& options = "", int poses = 700,
                  const std::string& terrain = "free") {
    const Result result = run("simulate --terrain " + terrain + " --noise 0.01 --out " + folder.path(name) +
                              " --poses " + std::to_string(poses) + sensors + options);
    EXPECT_EQ(result.code, 0) << result.error;
    std::string files;
    for (const char* sensor : {"lidar", "camera", "radar"})
      files += " " + folder.path(name) + "/" + sensor + ".tum";
    return files;
  }

  const std::string sensors =
      " --sensor lidar=0,0,1.8,1,0,0,0 --sensor camera=1.5,0.2,1.5,0.5,-0.5,0.5,-0.5 --sensor "
      "radar=2,0,0.5,1,0,0,0 ";
  testing::ScratchFolder folder;
};

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

TEST_F(Command, OffsetsOfARigThatRepeatsItsMotionAreOpen) {
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

TEST_F(Command, ARigOfThreeClosesItsLoopAndIsCertified) {
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
  EXPECT_TRUE(object["findings"].empty());
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

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

TEST_F(Command, APairsAnswerIsThatOfItsTwoStreamsAlone) {
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

TEST_F(Command, TheJointAnswerStatesItsOwnSpread) {
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

TEST_F(Command, TwoSensorsThatShareNoTimeLeaveTheOthers) {
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
  EXPECT_EQ(object["joint"]["tree"].size(), 2u);
  // without the one that connects them
  const Result apart = run("solve " + first + " " + last + " " + last);
  EXPECT_EQ(apart.code, 1);
  EXPECT_NE(apart.error.find("first"), std::string::npos) << apart.error;
}

TEST_F(Command, EachKeyOfTheRigFileIsUsed) {
  const std::vector<std::string> files =
      words_of(rig("drive", "--scale camera=2.7 --clock-offset radar=0.2"));
  const auto solve_with = [&](const std::string& of_camera, const std::string& of_radar,
                              const std::string& of_pair = "") {
    std::string text;
    for (const char* name : {"lidar", "camera", "radar"})
      text += std::string("[[sensor]]\nname = \"") + name + "\"\nchannel = \"" + name + "\"\n" +
              (name == std::string("camera") ? of_camera : "");
    text += "[[pair]]\na = \"lidar\"\nb = \"camera\"\n" + of_pair;
    text += "[[pair]]\na = \"lidar\"\nb = \"radar\"\n" + of_radar;
    const std::string toml = folder.file("rig.toml", text);
    return run("solve --json --rig " + toml + " --from lidar=" + files[0] + " --from camera=" + files[1] +
               " --from radar=" + files[2]);
  };
  const std::string truth = "truth = [1.5, 0.2, -0.3, 0.5, -0.5, 0.5, -0.5]\n";
  const json as_given = solve_with("", "").object();
  EXPECT_EQ(as_given["extrinsics"][0]["verdict"], "contradictory");
  // number, sign and cure are those of the sensor that is named
  bool scale = false, clock = false;
  double lacking = 0;
  for (const json& finding : as_given["findings"]) {
    EXPECT_EQ(finding["remedy"].dump().find("--scale"), std::string::npos) << finding["remedy"];
    if (finding["code"] == "scale" && finding["sensor"] == "camera") {
      scale = true;
      EXPECT_NEAR(finding["value"].get<double>(), 2.7, 0.05);
      EXPECT_NE(finding["message"].dump().find("The lengths of camera times 2."), std::string::npos);
      EXPECT_NE(finding["remedy"].dump().find("for camera"), std::string::npos);
    }
    if (finding["code"] == "clock_offset" && finding["sensor"] == "radar") {
      clock = true;
      lacking = finding["value"].get<double>();
      EXPECT_NEAR(std::abs(lacking), 0.2, 0.01);
      EXPECT_NE(finding["message"].dump().find("the stamps of radar"), std::string::npos);
    }
  }
  EXPECT_TRUE(scale) << as_given["findings"];
  EXPECT_TRUE(clock) << as_given["findings"];
  for (const std::string& offset : {std::to_string(lacking), std::string("\"auto\"")}) {
    const Result cured = solve_with("scale = 2.7\n", "time_offset = " + offset + "\n", truth);
    ASSERT_EQ(cured.code, 0) << cured.out;
    const json object = cured.object();
    for (const json& extrinsic : object["extrinsics"]) EXPECT_EQ(extrinsic["verdict"], "good") << offset;
    EXPECT_LT(object["extrinsics"][0]["error_translation_m"], 0.05);
    EXPECT_NEAR(object["extrinsics"][1]["time_offset_s"].get<double>(), lacking, 0.01);
  }
  const std::string cured = "time_offset = " + std::to_string(lacking) + "\n";
  const Result goal = solve_with("scale = 2.7\n", cured, "goal = \"0.0001deg,0.001cm\"\n");
  EXPECT_EQ(goal.code, 3);
  EXPECT_FALSE(goal.object()["extrinsics"][0]["goal"]["reached"]);
  const json stride = solve_with("scale = 2.7\n", cured, "stride = 3\nweights = \"equal\"\n").object();
  EXPECT_EQ(stride["extrinsics"][0]["stride"], 3);
  EXPECT_EQ(stride["extrinsics"][0]["weights"]["translation"], 1);
  const Result unknown = solve_with("scale = \"auto\"\n", "");
  EXPECT_EQ(unknown.code, 1);
  for (const char* part : {"rig.toml", "camera", "scale = \"auto\"", "solve A B"})
    EXPECT_NE(unknown.error.find(part), std::string::npos) << unknown.error;
}

TEST_F(Command, TheConsistentSetIsWrittenAsOneTree) {
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

TEST_F(Command, ASensorThatIsWrongIsNamed) {
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

TEST_F(Command, ARelocalisationIsNoMovedMount) {
  const Result result = run("solve --json" + rig("jump", "--jump camera=40:0.5,0,0,0,0,5", 1200));
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.object()["blamed"].is_null());
}

TEST_F(Command, ARigFileNamesItsSensors) {
  const std::string log = folder.path("drive.log"), toml = folder.path("rig.toml");
  ASSERT_EQ(
      run("simulate --terrain free --noise 0.01 --poses 400 --out " + log + " --rig-out " + toml + sensors)
          .code,
      0);
  const Result logged = run("solve --json --rig " + toml + " --log " + log);
  ASSERT_EQ(logged.code, 0) << logged.error;
  EXPECT_EQ(logged.object()["extrinsics"].size(), 3u);
  EXPECT_EQ(logged.object()["extrinsics"][2]["b"], "radar");
  rig("files", "", 400);
  const auto from = [&](const std::string& name) {
    return " --from " + name + "=" + folder.path("files") + "/" + name + ".tum";
  };
  const Result named = run("solve --json --rig " + toml + from("radar") + from("lidar") + from("camera"));
  ASSERT_EQ(named.code, 0) << named.error;
  EXPECT_EQ(named.object()["extrinsics"][0]["a"], "radar");
  const Result unknown = run("solve --rig " + toml + " --from sonar=x --from lidar=y");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_NE(unknown.error.find("sonar"), std::string::npos);
}

TEST_F(Command, WhatDoesNotGoTogetherIsRefused) {
  const std::string files = rig("drive", "", 50);
  for (const char* option : {" --scale auto", " --truth 0,0,0,1,0,0,0", " --pairs x", " --time-offset 0.1",
                             " --append x", " --method analytic"}) {
    const Result result = run("solve" + files + option);
    EXPECT_EQ(result.code, 2) << option << result.error;
    EXPECT_TRUE(result.out.empty()) << option;
  }
  EXPECT_EQ(run("solve --rig " + folder.path("none.toml")).code, 1);
  const Result missing = run("solve" + files + " " + folder.path("none.tum"));
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.error.find("none.tum"), std::string::npos);
}

TEST_F(Command, AnotherDriveOfTheRigAddsUp) {
  const std::string one = rig("one", "--seed 1", 300), two = rig("two", "--seed 2", 300);
  const json single = run("solve --json" + one).object();
  std::string append;
  std::istringstream files(two);
  for (std::string file; files >> file;) append += " " + file;
  const Result result = run("solve --json" + one + " --append" + append);
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_GT(result.object()["extrinsics"][0]["pairs"], 1.8 * single["extrinsics"][0]["pairs"].get<double>());
}

TEST_F(Command, TheScaleOfACameraIsFound) {
  const std::string drive = folder.path("mono");
  ASSERT_EQ(run("simulate --terrain rough --noise 0.01 --poses 1200 --scale camera=2.7 --out " + drive).code,
            0);
  const std::string files = " " + drive + "/camera.tum " + drive + "/lidar.tum";
  const Result result = run("solve --json --scale auto" + files);
  ASSERT_EQ(result.code, 0) << result.error;
  const json scale = result.object()["scale"];
  EXPECT_NEAR(scale["value"].get<double>(), 2.7, 3 * scale["stddev"].get<double>());
  EXPECT_NEAR(scale["value"].get<double>(), 2.7, 0.005 * 2.7);
  EXPECT_TRUE(scale["certified"]);
  EXPECT_TRUE(scale["observable"]);
  EXPECT_LE(scale["least"], scale["value"]);
  EXPECT_GE(scale["most"], scale["value"]);
  EXPECT_TRUE(result.object()["certified"]);
  // from the other side, and given
  const std::string turned = " " + drive + "/lidar.tum " + drive + "/camera.tum";
  const json on_b = run("solve --json --scale-b auto" + turned).object();
  EXPECT_NEAR(on_b["scale"]["value"].get<double>(), 2.7, 0.005 * 2.7);
  const json given = run("solve --json --scale-b 2.7" + turned).object();
  EXPECT_EQ(given["scale_applied"], 2.7);
  EXPECT_FALSE(given.contains("scale"));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(given["translation"][i].get<double>(), on_b["translation"][i].get<double>(), 0.02);
  for (const char* wrong :
       {" --scale 0", " --scale -1", " --scale nan", " --scale x", " --scale 1 --scale-b 1"}) {
    const Result refused = run("solve" + files + wrong);
    EXPECT_EQ(refused.code, 2) << wrong;
    EXPECT_TRUE(refused.out.empty()) << wrong;
  }
}

TEST_F(Command, AScaleThatDriftsIsFollowed) {
  const std::string drive = folder.path("drifting");
  ASSERT_EQ(
      run("simulate --terrain free --noise 0.01 --poses 1200 --scale camera=4 --scale-drift camera=0.002 "
          "--out " +
          drive)
          .code,
      0);
  const Result result = run("solve --json --scale auto " + drive + "/camera.tum " + drive +
                            "/lidar.tum --truth 0.2,-0.3,-0.5,0.5,0.5,-0.5,0.5");
  ASSERT_EQ(result.code, 0) << result.error;
  const json object = result.object();
  const json& segments = object["scale"]["segments"];
  ASSERT_FALSE(segments.empty());
  EXPECT_NEAR(segments.front()["begin_scale"].get<double>(), 4, 0.06);
  EXPECT_NEAR(segments.back()["end_scale"].get<double>(), 4 * std::exp(0.24), 0.08);
  EXPECT_LT(object["error_rotation_deg"], 0.2);
  EXPECT_LT(object["error_translation_m"], 0.05);
  EXPECT_TRUE(object["certified"]);
}

TEST_F(Command, TheScaleOfTwoDrivesIsOne) {
  std::string drives[2];
  for (int i = 0; i < 2; ++i) {
    drives[i] = folder.path("mono" + std::to_string(i));
    ASSERT_EQ(run("simulate --terrain free --noise 0.01 --poses 300 --scale camera=0.37 --out " + drives[i] +
                  " --seed " + std::to_string(i + 1))
                  .code,
              0);
  }
  const auto files = [&](int i) { return " " + drives[i] + "/camera.tum " + drives[i] + "/lidar.tum"; };
  const json one = run("solve --json --scale auto" + files(0)).object();
  const Result both = run("solve --json --scale auto" + files(0) + " --append" + files(1));
  ASSERT_EQ(both.code, 0) << both.error;
  EXPECT_NEAR(both.object()["scale"]["value"].get<double>(), 0.37, 0.005 * 0.37);
  EXPECT_GT(both.object()["pairs"], 1.5 * one["pairs"].get<double>());
}

TEST_F(Command, AKittiCameraWithoutScaleGivesTheSameExtrinsic) {
  const std::string kitti = paths::data_dir() + "/kitti_07/";
  std::ifstream camera(kitti + "cam0_orbslam2.tum");
  if (!camera) GTEST_SKIP() << "no drive at " << kitti;
  // every length divided by 0.37
  std::ostringstream scaled;
  scaled.precision(17);
  for (std::string line; std::getline(camera, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream numbers(line);
    double value[8];
    for (double& number : value) numbers >> number;
    for (int i = 1; i < 4; ++i) value[i] *= 0.37;
    for (int i = 0; i < 8; ++i) scaled << (i ? " " : "") << value[i];
    scaled << "\n";
  }
  const std::string mono = folder.file("mono.tum", scaled.str());
  const std::string lidar = kitti + "velodyne_pylidar.tum ";
  const json whole = run("solve --json --scale-b auto " + lidar + kitti + "cam0_orbslam2.tum").object();
  const json found = run("solve --json --scale-b auto " + lidar + mono).object();
  EXPECT_NEAR(found["scale"]["value"].get<double>() * 0.37, whole["scale"]["value"].get<double>(), 1e-4);
  EXPECT_NEAR(found["scale"]["value"].get<double>() * 0.37, 1, 0.005);
  double difference = 0, length = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    difference += std::pow(found["translation"][i].get<double>() - whole["translation"][i].get<double>(), 2);
    length += std::pow(whole["translation"][i].get<double>(), 2);
  }
  EXPECT_LT(std::sqrt(difference), 0.05 * std::sqrt(length));
}

}  // namespace
}  // namespace egocal
