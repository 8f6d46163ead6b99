// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve --append`: whose mount differs between two drives.
#include <gtest/gtest.h>

#include <numbers>
#include <sstream>
#include <string>

#include "egocal/geometry/pose.hpp"
#include "rig_command.hpp"

namespace egocal::test_append_command {
namespace {

class AppendCommand : public testing::RigCommand {
 protected:
  /// " A B" of two minutes of a lidar and a camera at x [m] that is turned by yaw [deg].
  std::string drive_of(int seed, double yaw, const std::string& options = "", double x = 1.5) {
    const std::string name = folder.path("drive" + std::to_string(seed));
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5) * rotation_exp({0, yaw * std::numbers::pi / 180, 0});
    std::ostringstream camera;
    camera.precision(17);
    camera << "camera=" << x << ",0.2,1.5," << q.w() << ',' << q.x() << ',' << q.y() << ',' << q.z();
    const Result made =
        run("simulate --poses 1200 --roughness 0.3 --noise 0.01 --seed " + std::to_string(seed) +
            " --sensor lidar=1,0,1.8,1,0,0,0 --sensor " + camera.str() + " " + options + " --out " + name);
    EXPECT_EQ(made.code, 0) << made.error;
    return " " + name + "/lidar.tum " + name + "/camera.tum";
  }
};

// A mount that was moved between two drives was said to creep by 4.8 deg an hour.
TEST_F(AppendCommand, AMountThatDiffersBetweenTwoDrivesIsNamedSo) {
  for (const int seed : {1, 11}) {
    const std::string first = drive_of(seed, 0), second = drive_of(seed + 1, 5),
                      third = drive_of(seed + 2, 0);
    const Result two = run("solve --json" + first + " --append" + second);
    EXPECT_EQ(two.code, 3) << two.error;
    const nlohmann::json found = two.object();
    ASSERT_EQ(found["findings"].size(), 1u) << found["findings"];
    EXPECT_EQ(found["findings"][0]["code"], "mount_moved");
    EXPECT_EQ(found["findings"][0].value("time", nlohmann::json()), nlohmann::json()) << "it has none";
    const std::string message = found["findings"][0]["message"];
    EXPECT_TRUE(message.starts_with("The mounts of drive 1 (")) << message;
    EXPECT_NE(message.find(") differ by "), std::string::npos) << message;
    const double degrees = std::stod(message.substr(message.find("differ by ") + 10));
    EXPECT_NEAR(degrees, 5, 0.1) << message;
    EXPECT_EQ(found["findings"][0]["remedy"],
              "Calibrate them separately: a mount was moved between these drives.");
    EXPECT_EQ(found["reason"], message);
    EXPECT_EQ(found["verdict"], "contradictory");

    const nlohmann::json three =
        run("solve --json" + first + " --append" + second + " --append" + third).object();
    ASSERT_EQ(three["findings"].size(), 2u) << three["findings"];
    EXPECT_TRUE(three["findings"][1]["message"].get<std::string>().starts_with("The mounts of drive 2 ("));

    const nlohmann::json same = run("solve --json" + first + " --append" + third).object();
    EXPECT_EQ(same["verdict"], "good") << same["reason"];
    EXPECT_TRUE(same["findings"].empty()) << same["findings"];
  }
}

bool is_of_mounts(const nlohmann::json& text) {
  return text.get<std::string>().starts_with("The mounts of drive 1 (");
}

// Such a difference was all that was said, whatever was wrong with a third drive.
TEST_F(AppendCommand, ASmallDifferenceLeavesTheVerdictAndHidesNoFault) {
  for (const int seed : {1, 11}) {
    const std::string two = drive_of(seed, 0) + " --append" + drive_of(seed + 1, 0.3);
    const nlohmann::json small = run("solve --json" + two).object();
    EXPECT_EQ(small["verdict"], "doubtful") << "within what is tolerated";
    ASSERT_EQ(small["findings"].size(), 1u) << small["findings"];
    EXPECT_TRUE(is_of_mounts(small["reason"])) << small["reason"];

    const std::string scaled = drive_of(seed + 2, 0, "--scale camera=1.5");
    const nlohmann::json three = run("solve --json" + two + " --append" + scaled).object();
    EXPECT_FALSE(is_of_mounts(three["reason"])) << three["reason"];
    ASSERT_GE(three["findings"].size(), 2u) << three["findings"];
    EXPECT_TRUE(is_of_mounts(three["findings"][0]["message"])) << three["findings"];
    EXPECT_NE(three["findings"].dump().find("scale_change"), std::string::npos) << three["findings"];
  }
}

// Of a camera without scale: each drive may have a unit of its own.
TEST_F(AppendCommand, LengthsOfAnUnknownUnitAreNotCompared) {
  const std::string half = "--scale camera=0.5";
  const std::string first = drive_of(1, 0, half);
  const nlohmann::json found =
      run("solve --json --scale auto" + first + " --append" + drive_of(2, 5, half, 3.5)).object();
  ASSERT_EQ(found["findings"].size(), 1u) << found["findings"];
  const std::string message = found["findings"][0]["message"];
  EXPECT_NE(message.find(") differ by 5.0"), std::string::npos) << message;
  EXPECT_EQ(message.find(" cm"), std::string::npos) << message;
}

}  // namespace
}  // namespace egocal::test_append_command
