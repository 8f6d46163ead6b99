// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve` where a camera has no scale.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "rig_command.hpp"

namespace egocal::test_scale_command {
namespace {

using nlohmann::json;

using ScaleCommand = testing::RigCommand;

TEST_F(ScaleCommand, TheScaleOfACameraIsFound) {
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

/// What each line of the text is about, but for those that belong to the line before.
std::vector<std::string> headings(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line[0] != ' ') result.push_back(line.substr(0, line.find_first_of(" ,")));
  return result;
}

/// "scale         changes along the drive" stood in the text of every drive.
TEST_F(ScaleCommand, ThatAScaleChangesIsSaidWhereItDoesOnly) {
  const std::string drive = folder.path("drive");
  ASSERT_EQ(run("simulate --terrain rough --noise 0.01 --poses 600 --out " + drive).code, 0);
  const std::string files = " " + drive + "/lidar.tum " + drive + "/camera.tum";
  const Result plain = run("solve" + files);
  ASSERT_EQ(plain.code, 0) << plain.error;
  EXPECT_THAT(headings(plain.out),
              ::testing::ElementsAre("verdict", "fit", "optimality", "T_a_b", "T_b_a", "motions", "outliers",
                                     "stream", "stream", "pairing", "certificate", "uncertainty"))
      << plain.out;
  for (const std::string option : {" --scale-b 1.001", " --scale-b auto"}) {
    const Result scaled = run("solve" + option + files);
    const std::vector<std::string> found = headings(scaled.out);
    EXPECT_EQ(std::count(found.begin(), found.end(), "scale"), 1) << option << "\n" << scaled.out;
    EXPECT_EQ(scaled.out.find("changes along the drive"), std::string::npos) << option << "\n" << scaled.out;
  }
}

/// The camera as B and --scale auto: the answer was in the camera's unit under "[m]", good, without a word.
TEST_F(ScaleCommand, WhoseUnitTheAnswerIsInIsSaid) {
  const std::string drive = folder.path("mono");
  ASSERT_EQ(run("simulate --terrain rough --noise 0.01 --poses 600 --scale camera=2.7 --out " + drive).code,
            0);
  const std::string files = " " + drive + "/lidar.tum " + drive + "/camera.tum";
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  };
  const Result result = run("solve --scale auto" + files);
  has(result.out,
      "\nunit          lengths are in the unit of b, also where m or cm is written: metres only if b");
  has(result.out, "  translation x y z [unit of b] ");
  EXPECT_EQ(result.out.find("x y z [m]"), std::string::npos) << result.out;
  has(result.out, " times the lengths of a are those of b; certified");
  has(result.error,
      "if a does and b is the camera without scale: --scale-b auto, otherwise --scale-a auto\n");
  const Result written = run("solve --scale auto --format yaml" + files);
  has(written.out, "\n# lengths in the unit of b, radians");
  has(written.out, "; the translation is in the unit of b, metres only if b measures metres\n");
  EXPECT_EQ(written.out.find("are metres"), std::string::npos) << written.out;
  has(written.error, "are those of b, and the translation is in their unit");
  const json scale = run("solve --json --scale auto" + files).object()["scale"];
  EXPECT_EQ(scale["of"], "a");
  EXPECT_EQ(scale["unit_of"], "b");
  EXPECT_FALSE(scale["metres"]);
  has(run("align --scale auto" + files).out, "[unit of b], quaternion");
  // who names the side has thought of it: the unit is said all the same
  for (const std::string option : {"--scale-a auto", "--scale-b auto"}) {
    const Result named = run("solve " + option + files);
    EXPECT_EQ(named.error, "") << option;
    has(named.out, option == "--scale-a auto" ? "x y z [unit of b]" : "x y z [unit of a]");
  }
  EXPECT_EQ(run("solve --scale 2 --scale-a 2" + files).code, 2);
}

TEST_F(ScaleCommand, AScaleNextToOneLeavesMetres) {
  const std::string drive = folder.path("wheels");
  ASSERT_EQ(run("simulate --terrain rough --noise 0.01 --poses 600 --scale camera=1.02 --out " + drive).code,
            0);
  const Result result = run("solve --scale auto " + drive + "/lidar.tum " + drive + "/camera.tum");
  EXPECT_NE(result.out.find("x y z [m]"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("\nunit "), std::string::npos) << result.out;
  EXPECT_EQ(result.error, "");
}

/// A COLMAP model has no scale for certain: as the stream that is not scaled it was good, and in no metres.
TEST_F(ScaleCommand, AModelWithoutScaleDoesNotGiveMetres) {
  const std::string drive = folder.path("mono");
  ASSERT_EQ(run("simulate --terrain free --noise 0.01 --poses 300 --scale camera=2.7 --out " + drive).code,
            0);
  std::ifstream camera(drive + "/camera.tum");
  std::string images =
      "# Image list with two lines of data per image:\n# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, "
      "NAME\n";
  int image = 0;
  for (std::string line; std::getline(camera, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream numbers(line);
    double t[3], q[4];
    std::string time;
    numbers >> time >> t[0] >> t[1] >> t[2] >> q[1] >> q[2] >> q[3] >> q[0];
    const Eigen::Quaterniond R(q[0], -q[1], -q[2], -q[3]);
    const Eigen::Vector3d inverted = -(R * Eigen::Vector3d(t[0], t[1], t[2]));
    std::ostringstream row;
    row.precision(17);
    row << ++image << " " << R.w() << " " << R.x() << " " << R.y() << " " << R.z() << " " << inverted.x()
        << " " << inverted.y() << " " << inverted.z() << " 1 image_" << time << ".png\n\n";
    images += row.str();
  }
  const std::string model = " " + folder.file("images.txt", images), lidar = " " + drive + "/lidar.tum";
  const Result wrong = run("solve --scale-a auto" + lidar + model);
  EXPECT_NE(
      wrong.error.find("in the unit of b, whose format has no scale: these are not metres; if a measures "
                       "metres: --scale-b auto\n"),
      std::string::npos)
      << wrong.error;
  EXPECT_NE(wrong.out.find("x y z [unit of b]"), std::string::npos) << wrong.out;
  const Result right = run("solve --scale-b auto" + lidar + model);
  EXPECT_EQ(right.error.find("metres"), std::string::npos) << right.error;
  EXPECT_NE(right.out.find("x y z [m]"), std::string::npos) << right.out;
  // two of them share one unit, which is unknown
  const Result both = run("solve" + model + model);
  EXPECT_NE(both.out.find("x y z [unit of "), std::string::npos) << both.out;
  EXPECT_EQ(run("align --json" + model + model).object()["metres"], false);
}

TEST_F(ScaleCommand, AScaleThatDriftsIsFollowed) {
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
  // the file and the page had the mean only, "estimated and proven"
  const std::string streams = " --scale auto " + drive + "/camera.tum " + drive + "/lidar.tum";
  const std::string yaml = run("solve --format yaml" + streams).out;
  EXPECT_NE(yaml.find("  certified: false\n  changes: true  #"), std::string::npos) << yaml;
  ASSERT_EQ(run("report --out " + folder.path("page.html") + streams).code, 0);
  const std::string page = testing::content_of(folder.path("page.html"));
  EXPECT_NE(page.find("changes along the drive"), std::string::npos);
  EXPECT_NE(page.find("drifts from "), std::string::npos);
}

TEST_F(ScaleCommand, TheScaleOfTwoDrivesIsOne) {
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

TEST_F(ScaleCommand, AKittiCameraWithoutScaleGivesTheSameExtrinsic) {
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

/// A scale from 0.01 to 100 is searched. The cure was the option that had been given.
TEST_F(ScaleCommand, AScaleBeyondWhatIsSearchedIsSaidWithItsCure) {
  const std::string drive = folder.path("mono");
  ASSERT_EQ(run("simulate --terrain free --noise 0.01 --poses 600 --scale camera=5000 --out " + drive).code,
            0);
  const std::string files = " " + drive + "/camera.tum " + drive + "/lidar.tum";
  const Result result = run("solve --json --scale auto" + files);
  const json object = result.object();
  EXPECT_NE(object["verdict"], "good");
  EXPECT_TRUE(object["scale"]["at_limit"]);
  const auto reason = object["reason"].get<std::string>();
  EXPECT_NE(reason.find("is the end, 100, of the range that was searched, 0.01 to 100. Multiply the lengths "
                        "of a by 100 first."),
            std::string::npos)
      << reason;
  EXPECT_NE(run("solve --scale auto" + files).out.find("100 NOT FOUND: the end of the range"),
            std::string::npos);
  for (const json& finding : object["findings"])
    if (finding["code"] == "scale" || finding["code"] == "units") {
      EXPECT_EQ(finding["remedy"].get<std::string>().rfind("--scale 5", 0), 0u) << finding;
    }
}

}  // namespace
}  // namespace egocal::test_scale_command
