// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve --rig`, and options that do not go with rigs.
#include <gmock/gmock.h>

#include "rig_command.hpp"

namespace egocal::test_rig_file_command {
namespace {

using nlohmann::json;
using testing::words_of;

using RigFile = testing::RigCommand;

TEST_F(RigFile, EachKeyOfTheRigFileIsUsed) {
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

TEST_F(RigFile, ARigFileNamesItsSensors) {
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

/// A rig of three on flat ground, with one pair listed.
class RigOnFlatGround : public RigFile {
 protected:
  Result solve_with(const std::string& pair) {
    if (files_.empty()) files_ = words_of(rig("flat", "", 700, "flat"));
    const char* names[] = {"lidar", "camera", "radar"};
    const char* planes[] = {"[0.0, 0.0, 1.0, -1.8]", "[0.0, -1.0, 0.0, -1.5]", "[0.0, 0.0, 1.0, -0.5]"};
    std::string text, from;
    for (std::size_t k = 0; k < 3; ++k) {
      text += std::string("[[sensor]]\nname = \"") + names[k] + "\"\nchannel = \"" + names[k] +
              "\"\nplane = " + planes[k] + "\n";
      from += std::string(" --from ") + names[k] + "=" + files_[k];
    }
    return run("solve --json --rig " + folder.file("rig.toml", text + "[[pair]]\n" + pair) + from);
  }
  std::vector<std::string> files_;
};

// It was ignored without a word.
TEST_F(RigOnFlatGround, ANominalValueIsComparedInPlanarMode) {
  const std::string pair = "a = \"lidar\"\nb = \"camera\"\nmode = \"planar\"\nnominal = ";
  const json right = solve_with(pair + "[1.5, 0.2, -0.3, 0.5, -0.5, 0.5, -0.5]\n").object();
  EXPECT_EQ(right["extrinsics"][0]["verdict"], "good");
  const json wrong = solve_with(pair + "[1.5, 0.2, 0.9, 0.5, -0.5, 0.5, -0.5]\n").object();
  EXPECT_EQ(wrong["extrinsics"][0]["verdict"], "doubtful");
  EXPECT_THAT(wrong["findings"].dump(),
              ::testing::HasSubstr("120 cm (z) from what the ground planes and the motions show"));
}

// A height by a ruler was doubtful: the other numbers, which had to be given, contradicted the motions.
TEST_F(RigOnFlatGround, APartOfANominalValueIsEnough) {
  for (const char* pair : {"a = \"lidar\"\nb = \"camera\"\nnominal = [nan, nan, -0.3]\n",
                           "a = \"camera\"\nb = \"lidar\"\nnominal = [nan, -0.3, nan]\n"}) {
    const Result result = solve_with(pair);
    EXPECT_EQ(result.code, 0) << result.out;
    const json extrinsic = result.object()["extrinsics"][0];
    EXPECT_EQ(extrinsic["verdict"], "incomplete") << extrinsic["reason"];
    EXPECT_NEAR(extrinsic["translation"][2].get<double>(), -0.3, 0.01) << pair;
  }
  const Result none = solve_with("a = \"lidar\"\nb = \"camera\"\nnominal = [nan, nan, nan]\n");
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.error, ::testing::HasSubstr("nominal: nothing of it is known"));
}

// The cure asked for the pose of the camera in the lidar, which was what stood there.
TEST_F(RigOnFlatGround, ANominalValueOfAReversedPairIsCuredInItsDirection) {
  const json found =
      solve_with("a = \"camera\"\nb = \"lidar\"\nnominal = [1.5, 0.2, -0.3, 0.5, -0.5, 0.5, -0.5]\n")
          .object();
  ASSERT_FALSE(found["findings"].empty());
  EXPECT_EQ(found["findings"][0]["remedy"],
            "Correct the nominal value, whose inverse agrees: give the pose of lidar in camera, not that of "
            "camera in lidar.");
  EXPECT_THAT(found["findings"][0]["message"].get<std::string>(),
              ::testing::StartsWith("lidar, camera (listed as camera, lidar; in the axes of lidar): "));
}

TEST_F(RigFile, WhatDoesNotGoTogetherIsRefused) {
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

}  // namespace
}  // namespace egocal::test_rig_file_command
