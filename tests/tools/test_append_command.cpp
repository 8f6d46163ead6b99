// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve --append`: whose mount differs between two drives.
#include <gtest/gtest.h>

#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "egocal/geometry/pose.hpp"
#include "egocal/io/trajectory_file.hpp"
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
        run("simulate --poses 1200 --roughness 0.3 --seed " + std::to_string(seed) +
            (options.find("--noise") == std::string::npos ? " --noise 0.01" : "") +
            " --sensor lidar=1,0,1.8,1,0,0,0 --sensor " + camera.str() + " " + options + " --out " + name);
    EXPECT_EQ(made.code, 0) << made.error;
    return " " + name + "/lidar.tum " + name + "/camera.tum";
  }
};

// A mount that was moved between two drives was said to creep by 4.8 deg an hour.
TEST_F(AppendCommand, AMountThatDiffersBetweenTwoDrivesIsNamedSo) {
  constexpr int seed = 1;
  const std::string first = drive_of(seed, 0), second = drive_of(seed + 1, 5), third = drive_of(seed + 2, 0);
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

// One offset for all drives was half-way between theirs, with a drift that no clock had.
TEST_F(AppendCommand, DrivesWhoseClocksWereSetAnewHaveAnOffsetEach) {
  const std::string first = drive_of(1, 0), second = drive_of(2, 0, "--clock-offset camera=0.3"),
                    third = drive_of(3, 0, "--clock-offset camera=-0.08");
  const std::string all = first + " --append" + second + " --append" + third + " --time-offset auto";
  const nlohmann::json found = run("solve --json" + all).object();
  EXPECT_EQ(found["verdict"], "good") << found["reason"];
  EXPECT_TRUE(found["findings"].empty()) << found["findings"];
  EXPECT_TRUE(found["time_offset_s"].is_null());
  EXPECT_FALSE(found.contains("time_offset_estimate"));
  ASSERT_EQ(found["time_offsets"].size(), 3u);
  const double offsets[] = {0, -0.3, 0.08};
  for (std::size_t k = 0; k < 3; ++k) {
    const nlohmann::json& one = found["time_offsets"][k];
    EXPECT_NEAR(one["seconds"].get<double>(), offsets[k], 2e-3) << k;
    EXPECT_TRUE(one["drive"].get<std::string>().ends_with("drive" + std::to_string(k + 1) + "/lidar.tum"));
  }
  EXPECT_NEAR(found["translation"][0].get<double>(), 0.5, 0.03);
  const std::string text = run("solve" + all).out;
  EXPECT_NE(text.find("s added to b in drive 2 ("), std::string::npos) << text;
  EXPECT_EQ(text.find("clock drift"), std::string::npos) << text;
  // one clock: one estimate
  const nlohmann::json one =
      run("solve --json" + first + " --append" + drive_of(4, 0) + " --time-offset auto").object();
  EXPECT_FALSE(one.contains("time_offsets"));
  EXPECT_NEAR(one["time_offset_s"].get<double>(), 0, 2e-3);
}

// Offsets that noise leaves uncertain by hundredths of a second, beside clocks that differ by far more.
TEST_F(AppendCommand, NoisyDrivesHaveTheirOffsetsAndOneWithoutACertainOneIsRefused) {
  const std::string first = drive_of(5, 0, "--noise 0.1"),
                    second = drive_of(6, 0, "--noise 0.1 --clock-offset camera=0.3"),
                    third = drive_of(7, 0, "--noise 1 --clock-offset camera=-0.2");
  const std::string two = first + " --append" + second + " --time-offset auto";
  const nlohmann::json found = run("solve --json" + two).object();
  ASSERT_EQ(found["time_offsets"].size(), 2u) << found["reason"];
  EXPECT_NEAR(found["time_offsets"][0]["seconds"].get<double>(), 0, 0.03);
  EXPECT_NEAR(found["time_offsets"][1]["seconds"].get<double>(), -0.3, 0.03);
  const Result refused = run("solve" + two + " --append" + third);
  EXPECT_EQ(refused.code, 1);
  EXPECT_EQ(refused.out, "");
  EXPECT_NE(refused.error.find("drive7/lidar.tum: the time offset of this drive is not certain ("),
            std::string::npos)
      << refused.error;
  EXPECT_NE(refused.error.find("and the clocks of the other drives differ: leave it out\n"),
            std::string::npos)
      << refused.error;
}

// The same in a rig: the sensor's offsets are a note.
TEST_F(AppendCommand, ASensorOfARigWhoseClockWasSetAnewHasAnOffsetForEachDrive) {
  std::string names[2];
  for (int k = 0; k < 2; ++k) {
    names[k] = folder.path("rig" + std::to_string(k));
    ASSERT_EQ(run("simulate --poses 1200 --roughness 0.3 --noise 0.01 --seed " + std::to_string(11 + k) +
                  " --sensor lidar=1,0,1.8,1,0,0,0 --sensor camera=1.5,0.2,1.5,0.5,-0.5,0.5,-0.5"
                  " --sensor imu=0.2,0.1,1,1,0,0,0 --clock-offset camera=" +
                  (k == 0 ? "0.1" : "-0.2") + " --out " + names[k])
                  .code,
              0);
  }
  const auto drive = [](const std::string& name) {
    return " " + name + "/lidar.tum " + name + "/camera.tum " + name + "/imu.tum";
  };
  const Result result =
      run("solve --json" + drive(names[0]) + " --append" + drive(names[1]) + " --time-offset auto");
  EXPECT_EQ(result.code, 0) << result.error;
  const nlohmann::json found = result.object();
  for (const nlohmann::json& pair : found.at("extrinsics"))
    EXPECT_EQ(pair["verdict"], "good") << pair["reason"];
  const std::string words = "camera: its clock differs between the drives: ";
  const std::size_t at = result.error.find(words);
  ASSERT_NE(at, std::string::npos) << result.error;
  EXPECT_NEAR(std::stod(result.error.substr(at + words.size())), -0.1, 2e-3) << result.error;
  EXPECT_NEAR(std::stod(result.error.substr(result.error.find("), ", at) + 3)), 0.2, 2e-3) << result.error;
}

// Each drive by itself was contradictory, and both together were "good", with an answer 0.8 deg off.
TEST_F(AppendCommand, AFaultThatEachDriveShowsIsNotHiddenByTheOther) {
  const std::string creep = "--creep camera=10:110:0,0,0,0,0,3";
  const std::string both = drive_of(1, 0, creep) + " --append" + drive_of(2, 0, creep);
  for (const int seed : {1, 2}) {
    const nlohmann::json alone = run("solve --json" + drive_of(seed, 0, creep)).object();
    EXPECT_EQ(alone["verdict"], "contradictory") << alone["reason"];
  }
  const Result result = run("solve --json" + both);
  EXPECT_EQ(result.code, 3);
  const nlohmann::json found = result.object();
  EXPECT_EQ(found["verdict"], "contradictory");
  const std::string reason = found["reason"];
  EXPECT_TRUE(reason.starts_with("Drive 1 (") || reason.starts_with("Drive 2 (")) << reason;
  EXPECT_NE(reason.find(" by itself: "), std::string::npos) << reason;
  EXPECT_EQ(found["findings"][0]["code"], "mount_moved");
  EXPECT_TRUE(found["findings"][0]["remedy"].get<std::string>().starts_with("Correct the files of drive "))
      << found["findings"][0];
}

// The hour between two drives counted as driving: 24,000 instead of 700 s were left.
TEST_F(AppendCommand, TheTimeUntilAGoalIsThatOfDriving) {
  const auto left = [&](const std::string& drives) {
    const nlohmann::json found = run("solve --json --goal 0.001deg,0.1mm" + drives).object();
    EXPECT_FALSE(found["goal"]["reached"]);
    return found["goal"]["seconds_left"].get<double>();
  };
  const double one = left(drive_of(1, 0)), two = left(drive_of(1, 0) + " --append" + drive_of(2, 0));
  EXPECT_LT(two, 3 * one);
  EXPECT_GT(two, one / 3);
}

bool is_of_mounts(const nlohmann::json& text) {
  return text.get<std::string>().starts_with("The mounts of drive 1 (");
}

bool is_of_third(const nlohmann::json& text) {
  return text.get<std::string>().starts_with("Drive 3 (");
}

// Such a difference was all that was said, whatever was wrong with a third drive.
TEST_F(AppendCommand, ASmallDifferenceLeavesTheVerdictAndHidesNoFault) {
  constexpr int seed = 11;
  const std::string two = drive_of(seed, 0) + " --append" + drive_of(seed + 1, 0.3);
  const nlohmann::json small = run("solve --json" + two).object();
  EXPECT_EQ(small["verdict"], "doubtful") << "within what is tolerated";
  ASSERT_EQ(small["findings"].size(), 1u) << small["findings"];
  EXPECT_TRUE(is_of_mounts(small["reason"])) << small["reason"];

  const std::string scaled = drive_of(seed + 2, 0, "--scale camera=1.5");
  const nlohmann::json three = run("solve --json" + two + " --append" + scaled).object();
  EXPECT_EQ(three["verdict"], "contradictory");
  EXPECT_TRUE(is_of_third(three["reason"])) << three["reason"];
  ASSERT_EQ(three["findings"].size(), 2u) << three["findings"];
  EXPECT_EQ(three["findings"][0]["code"], "scale") << three["findings"];
  EXPECT_TRUE(is_of_mounts(three["findings"][1]["message"])) << three["findings"];
}

/// The same poses, world-to-sensor.
std::string inverted(const testing::ScratchFolder& folder, const std::string& file) {
  Trajectory poses = read_trajectory(file);
  for (StampedPose& pose : poses) pose.pose = conjugate(pose.pose);
  const std::string other = folder.path("inverted.tum");
  write_tum(other, poses);
  return other;
}

// The rotation was said to change by 64 deg within 12 s: a mounting that shakes.
TEST_F(AppendCommand, ADriveThatDiffersIsNamedWithWhatIsWrongOfIt) {
  constexpr int seed = 1;
  const std::vector<std::string> third = testing::words_of(drive_of(seed + 2, 0));
  const Result result = run("solve --json" + drive_of(seed, 0) + " --append" + drive_of(seed + 1, 0) +
                            " --append " + third[0] + " " + inverted(folder, third[1]));
  EXPECT_EQ(result.code, 3) << result.error;
  const nlohmann::json found = result.object();
  EXPECT_EQ(found["verdict"], "contradictory");
  ASSERT_FALSE(found["findings"].empty());
  EXPECT_EQ(found["findings"].dump().find("shakes"), std::string::npos) << found["findings"];
  const std::string code = found["findings"][0]["code"], cure = found["findings"][0]["remedy"];
  EXPECT_EQ(code, "inverted_b");
  EXPECT_TRUE(is_of_third(found["reason"])) << found["reason"];
  EXPECT_EQ(found["reason"], found["findings"][0]["message"]);
  EXPECT_TRUE(cure.starts_with("Correct the files of drive 3, or leave it out. By itself: ")) << cure;
  EXPECT_NE(cure.find("--invert-b"), std::string::npos) << cure;
}

// A drive between them that is wrong hid that the mounts differ.
TEST_F(AppendCommand, MountsAreComparedAcrossADriveThatIsWrong) {
  const std::vector<std::string> second = testing::words_of(drive_of(2, 0));
  const nlohmann::json found = run("solve --json" + drive_of(1, 0) + " --append " + second[0] + " " +
                                   inverted(folder, second[1]) + " --append" + drive_of(3, 5))
                                   .object();
  ASSERT_EQ(found["findings"].size(), 2u) << found["findings"];
  const std::string message = found["findings"][1]["message"];
  EXPECT_TRUE(message.starts_with("The mounts of drive 1 (")) << message;
  EXPECT_NE(message.find(" and drive 3 ("), std::string::npos) << message;
}

/// " A B C" of a rig whose camera is turned by yaw [deg].
class AppendToRig : public AppendCommand {
 protected:
  std::string rig_of(int seed, double yaw) {
    const std::string files = drive_of(seed, yaw, "--sensor radar=2,0,0.5,1,0,0,0");
    return files + " " + folder.path("drive" + std::to_string(seed)) + "/radar.tum";
  }
};

// It moved "at 5639.8 s", half an hour before the second drive began.
TEST_F(AppendToRig, AMountThatDiffersBetweenTwoDrivesIsThatOfASensor) {
  const Result result =
      run("solve --json" + rig_of(1, 0) + " --append" + rig_of(2, 0) + " --append" + rig_of(3, 5));
  EXPECT_EQ(result.code, 3) << result.error;
  const nlohmann::json found = result.object();
  EXPECT_EQ(found["blamed"], "camera");
  ASSERT_EQ(found["findings"].size(), 1u) << found["findings"];
  const nlohmann::json& finding = found["findings"][0];
  EXPECT_EQ(finding["code"], "mount_moved");
  EXPECT_EQ(finding["sensor"], "camera");
  EXPECT_FALSE(finding.contains("time")) << finding;
  const std::string message = finding["message"];
  EXPECT_TRUE(message.starts_with("camera: The mounts of drive 2 (")) << message;
  EXPECT_NEAR(std::stod(message.substr(message.find("differ by ") + 10)), 5, 0.1) << message;
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
