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
  /// " A B" of two minutes of a lidar and a camera that is turned by yaw [deg].
  std::string drive_of(int seed, double yaw) {
    const std::string name = folder.path("drive" + std::to_string(seed));
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5) * rotation_exp({0, yaw * std::numbers::pi / 180, 0});
    std::ostringstream camera;
    camera.precision(17);
    camera << "camera=1.5,0.2,1.5," << q.w() << ',' << q.x() << ',' << q.y() << ',' << q.z();
    const Result made =
        run("simulate --poses 1200 --roughness 0.3 --noise 0.01 --seed " + std::to_string(seed) +
            " --sensor lidar=1,0,1.8,1,0,0,0 --sensor " + camera.str() + " --out " + name);
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

}  // namespace
}  // namespace egocal::test_append_command
