// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// From any recording in to any format out, by the real program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/simulation/simulation.hpp"
#include "support/bag_writer.hpp"
#include "support/file_content.hpp"
#include "support/paths.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::test_recordings {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::MessageEncoder;

struct Outcome {
  int code = -1;
  std::string out, err;
};

class Recordings : public ::testing::Test {
 protected:
  Recordings() {
    SimulationOptions options;
    options.poses = 400;
    options.relative_noise = 0.001;
    options.terrain = Terrain::free;
    options.T_vehicle_sensor = {Pose{}, T};
    drive = simulate(options);
    for (Trajectory& trajectory : drive)
      for (StampedPose& pose : trajectory) pose.time_us += 1'700'000'000'000'000;
    const auto messages = [&](MessageEncoder::Kind kind) {
      auto all = testing::as_messages(drive[0], "/lidar", "nav_msgs/Odometry", kind);
      for (auto& message : testing::as_messages(drive[1], "/camera", "geometry_msgs/PoseStamped", kind))
        all.push_back(std::move(message));
      return all;
    };
    // as they are recorded: one after the other in time
    auto ros1 = messages(MessageEncoder::Kind::ros1), cdr = messages(MessageEncoder::Kind::cdr);
    for (auto* all : {&ros1, &cdr})
      std::stable_sort(all->begin(), all->end(),
                       [](const auto& x, const auto& y) { return x.time_us < y.time_us; });
    folder.file("drive.bag", testing::rosbag1_file(ros1, {"lz4"}));
    folder.file("drive.mcap", testing::mcap_file(cdr, {"zstd"}));
    testing::write_db3(folder.path("drive.db3"), cdr);
    write_tum(folder.path("lidar.tum"), drive[0]);
    write_tum(folder.path("camera.tum"), drive[1]);
  }

  Outcome egocal(const std::string& arguments) const {
    const std::string command =
        paths::bin_dir() + "/egocal " + arguments + " >" + folder.path("out") + " 2>" + folder.path("err");
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("out"), read("err")};
  }
  std::string read(const std::string& name) const { return testing::content_of(folder.path(name)); }
  json parsed(const std::string& arguments) const {
    const Outcome run = egocal(arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    return json::parse(run.out);
  }

  const Pose T{rotation_exp({0.3, -0.2, 1.0}), {0.5, -0.2, 0.3}};
  std::vector<Trajectory> drive;
  testing::ScratchFolder folder;
};

TEST_F(Recordings, EveryBagGivesTheAnswerOfTheTextFiles) {
  const json text = parsed("solve --json " + folder.path("lidar.tum") + " " + folder.path("camera.tum"));
  for (const char* name : {"drive.bag", "drive.mcap", "drive.db3"}) {
    const std::string file = folder.path(name);
    const json bag = parsed("solve --json " + file + ":/lidar " + file + ":camera");
    EXPECT_EQ(bag["pairs"], text["pairs"]) << name;
    EXPECT_TRUE(bag["certified"]) << name;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(bag["translation"][i].get<double>(), text["translation"][i].get<double>(), 1e-9) << name;
  }
  const Outcome unclear = egocal("solve " + folder.path("drive.bag") + " " + folder.path("drive.bag"));
  EXPECT_EQ(unclear.code, 1);
  EXPECT_EQ(unclear.out, "");
  EXPECT_THAT(unclear.err,
              HasSubstr("/lidar (nav_msgs/Odometry, 400), /camera (geometry_msgs/PoseStamped, 400)"));
}

/// It was said of FILE:CHANNEL alone.
TEST_F(Recordings, TimesThatAreThoseOfRecordingAreSaidOfALogToo) {
  bus::LogWriter writer(folder.path("drive.log"));
  for (std::size_t i = 0; i < drive[0].size(); ++i)
    for (const auto& [channel, poses] : {std::pair("LIDAR", &drive[0]), std::pair("CAMERA", &drive[1])}) {
      StampedPose pose = (*poses)[i];
      const std::int64_t recorded_us = std::exchange(pose.time_us, 0);
      writer.write(recorded_us, channel, bus::encode(bus::to_pose_message(pose)));
    }
  writer.close();
  const std::string note = ": 400 messages have no time stamp: the time of recording was taken";
  const Outcome run = egocal("solve LIDAR CAMERA --log " + folder.path("drive.log"));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, ::testing::AllOf(HasSubstr("LIDAR" + note), HasSubstr("CAMERA" + note)));
}

/// It was cut after 60 letters, and could not be given back.
TEST_F(Recordings, InfoPrintsTheWholeNameOfAStream) {
  const std::string topic = "/a_vehicle/with_many_parts/" + std::string(80, 'x') + "/odometry";
  folder.file("long.mcap",
              testing::mcap_file(
                  testing::as_messages(drive[0], topic, "nav_msgs/Odometry", MessageEncoder::Kind::cdr), {}));
  EXPECT_THAT(egocal("info " + folder.path("long.mcap")).out,
              HasSubstr("\n" + topic + "  nav_msgs/Odometry"));
}

TEST_F(Recordings, ColumnsAndRateGoWithEveryCommand) {
  const std::string a = folder.path("lidar.tum"), b = folder.path("camera.tum");
  const json usual = parsed("solve --json " + a + " " + b);
  // the same poses in another order of columns, for both and for one
  const auto turned = [&](const std::string& name, const Trajectory& trajectory) {
    std::stringstream text;
    text.precision(17);
    for (const StampedPose& stamped : trajectory) {
      const Pose pose = to_pose(stamped.pose);
      text << pose.rotation.w() << ' ' << pose.rotation.x() << ' ' << pose.rotation.y() << ' '
           << pose.rotation.z() << ' ' << pose.translation.x() << ' ' << pose.translation.y() << ' '
           << pose.translation.z() << '\n';
    }
    return folder.file(name, text.str());
  };
  const std::string own_a = turned("a.txt", drive[0]), own_b = turned("b.txt", drive[1]);
  const std::string columns = " --columns qw,qx,qy,qz,x,y,z --rate 10";
  const auto expect_usual = [&](const json& answer, const std::string& what) {
    EXPECT_EQ(answer["pairs"], usual["pairs"]) << what;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(answer["translation"][i].get<double>(), usual["translation"][i].get<double>(), 1e-6)
          << what;
  };
  expect_usual(parsed("solve --json " + own_a + " " + own_b + columns), "both");
  // the same poses would be the same recording
  const auto elsewhere = [](Trajectory trajectory) {
    const DualQuaternion world = to_dual_quaternion({rotation_exp({0, 0, 1}), {3, 2, 1}});
    for (StampedPose& pose : trajectory) pose.pose = world * pose.pose;
    return trajectory;
  };
  const json twice =
      parsed("solve --json " + own_a + " " + own_b + columns + " --append " +
             turned("c.txt", elsewhere(drive[0])) + " " + turned("d.txt", elsewhere(drive[1])));
  EXPECT_GT(twice["pairs"].get<int>(), 1.8 * usual["pairs"].get<int>());
  // the same file twice is the same stream: an answer that should not be used
  const Outcome same = egocal("solve --json " + own_a + " " + own_b + " " + own_a + columns);
  EXPECT_EQ(same.code, 3) << same.err;
  const json rig = json::parse(same.out);
  EXPECT_EQ(rig["extrinsics"].size(), 3u);
  EXPECT_EQ(egocal("check " + own_a + " " + own_b + columns).code, 0);
  EXPECT_EQ(egocal("align " + own_a + " " + own_b + columns).code, 0);
  EXPECT_EQ(parsed("info --json " + own_a + columns)["streams"][0]["poses"], 400);
  const Outcome none = egocal("solve " + own_a + " " + own_b);
  EXPECT_NE(none.code, 0);
}

TEST_F(Recordings, InfoSaysWhatAFileHolds) {
  const json info = parsed("info --json " + folder.path("drive.mcap"));
  EXPECT_EQ(info["format"], "MCAP");
  ASSERT_EQ(info["streams"].size(), 2u);
  const json& lidar = info["streams"][0];
  EXPECT_EQ(lidar["name"], "/lidar");
  EXPECT_EQ(lidar["poses"], 400);
  EXPECT_EQ(lidar["gaps"], 0);
  EXPECT_EQ(lidar["times_not_increasing"], 0);
  double path = 0;
  for (std::size_t i = 1; i < drive[0].size(); ++i)
    path += to_pose(conjugate(drive[0][i - 1].pose) * drive[0][i].pose).translation.norm();
  EXPECT_NEAR(lidar["path_length_m"].get<double>(), path, 1e-6 * path);
  const Outcome text = egocal("info " + folder.path("lidar.tum"));
  EXPECT_THAT(text.out, HasSubstr("table, 1 stream"));
  EXPECT_THAT(text.out, HasSubstr("poses           400"));
  // a gap, a jump and times out of order
  Trajectory damaged = drive[0];
  damaged.erase(damaged.begin() + 100, damaged.begin() + 150);
  damaged[200].pose = damaged[200].pose * to_dual_quaternion({Eigen::Quaterniond::Identity(), {500, 0, 0}});
  std::swap(damaged[300], damaged[301]);
  write_tum(folder.path("damaged.tum"), damaged);
  const json found = parsed("info --json " + folder.path("damaged.tum"))["streams"][0];
  EXPECT_EQ(found["gaps"], 1);
  EXPECT_EQ(found["jumps"], 2);  // there and back
  EXPECT_EQ(found["times_not_increasing"], 1);
}

TEST_F(Recordings, TheAnswerIsWrittenInEveryFormat) {
  const std::string files = folder.path("lidar.tum") + " " + folder.path("camera.tum");
  for (const char* format :
       {"yaml", "json", "ros", "ros-launch", "urdf", "kalibr", "autoware", "lio-sam", "opencv", "matrix"}) {
    const Outcome run = egocal("solve " + files + " --frame-a lidar --frame-b camera --format " + format +
                               " --out " + folder.path("answer"));
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(read("answer"), HasSubstr("lidar")) << format;
    EXPECT_THAT(read("answer"), HasSubstr("camera")) << format;
    const Outcome printed = egocal("solve " + files + " --frame-a lidar --frame-b camera --format " + format);
    EXPECT_EQ(printed.out, read("answer")) << format;
  }
  const json answer = json::parse(egocal("solve " + files + " --format json").out);
  EXPECT_NEAR(answer["T_parent_child"]["translation_m"]["x"].get<double>(), 0.5, 0.05);
  EXPECT_TRUE(answer["certified"]);
}

TEST_F(Recordings, AlignLaysOneTrajectoryOverTheOther) {
  const json result = parsed("align --json --out " + folder.path("aligned.tum") + " " +
                             folder.path("drive.bag") + ":/lidar " + folder.path("camera.tum"));
  EXPECT_LT(result["rms_translation_m"].get<double>(), 0.5);
  const Trajectory aligned = read_trajectory(folder.path("aligned.tum"));
  ASSERT_EQ(aligned.size(), drive[0].size());
  double sum = 0;
  for (std::size_t i = 0; i < aligned.size(); ++i)
    sum += (to_pose(aligned[i].pose).translation - to_pose(drive[0][i].pose).translation).squaredNorm();
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(aligned.size())), result["rms_translation_m"].get<double>(),
              1e-6);
}

TEST_F(Recordings, LogsAreMadeOfBagsAndBagsOfLogs) {
  folder.file(
      "rig.toml",
      "[[sensor]]\nname = \"lidar\"\nchannel = \"ODO_LIDAR\"\n[[sensor]]\nname = \"camera\"\nchannel = "
      "\"ODO_CAMERA\"\n[[pair]]\na = \"lidar\"\nb = \"camera\"\n");
  const Outcome made = egocal(
      "log create " + folder.path("rig.toml") + " --from lidar=" + folder.path("drive.mcap") +
      ":/lidar --from camera=" + folder.path("drive.db3") + ":/camera --out " + folder.path("drive.log"));
  ASSERT_EQ(made.code, 0) << made.err;
  ASSERT_EQ(egocal("log export " + folder.path("drive.log") + " --mcap " + folder.path("again.mcap")).code,
            0);
  const json again = parsed("solve --json " + folder.path("again.mcap") + ":/ODO_LIDAR " +
                            folder.path("drive.log") + ":ODO_CAMERA");
  EXPECT_TRUE(again["certified"]);
  EXPECT_NEAR(again["translation"][0].get<double>(), 0.5, 0.05);
  const Trajectory poses = read_trajectory(folder.path("again.mcap") + ":/ODO_LIDAR");
  const Trajectory transforms = read_trajectory(folder.path("again.mcap") + ":/tf:ODO_LIDAR_start/ODO_LIDAR");
  ASSERT_EQ(poses.size(), drive[0].size());
  ASSERT_EQ(transforms.size(), poses.size());
  EXPECT_LT((poses[50].pose.vec() - drive[0][50].pose.vec()).norm(), 1e-12);
  EXPECT_EQ(parsed("info --json " + folder.path("again.mcap"))["damaged_regions"], 0);
}

/// A message of nav_msgs.Odometry as lcm-gen's code writes it; its fingerprint is what lcm-gen 1.3.1
/// computed.
TEST_F(Recordings, RosShapedTypesOfLcmAreRead) {
  bus::LogWriter log(folder.path("ros.log"));
  const auto big = [](std::uint64_t value, int size) {
    std::string bytes;
    for (int i = size - 1; i >= 0; --i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
    return bytes;
  };
  const auto text = [&](const std::string& value) { return big(value.size() + 1, 4) + value + '\0'; };
  for (int i = 0; i < 50; ++i) {
    std::string message = big(0x94e17f94648cf0e4u, 8) + big(static_cast<std::uint64_t>(i), 4) +
                          big(1'700'000'000, 4) + big(static_cast<std::uint64_t>(i) * 10'000'000, 4) +
                          text("odom") + text("base");
    for (const double value : {0.1 * i, 2.0, 3.0, 0.0, 0.0, 0.6, 0.8})
      message += big(std::bit_cast<std::uint64_t>(value), 8);
    message += std::string((36 + 6 + 36) * 8, '\0');
    log.write(1'700'000'000'000'000 + 10'000 * i, "/odom#nav_msgs.Odometry",
              std::as_bytes(std::span(message.data(), message.size())));
  }
  log.close();
  const json info = parsed("info --json '" + folder.path("ros.log") + ":/odom#nav_msgs.Odometry'");
  EXPECT_EQ(info["streams"][0]["poses"], 50);
  EXPECT_EQ(info["streams"][0]["type"], "nav_msgs.Odometry");
  EXPECT_NEAR(info["streams"][0]["path_length_m"].get<double>(), 4.9, 1e-9);
  EXPECT_NEAR(info["streams"][0]["rate_hz"].get<double>(), 100, 1e-3);
  EXPECT_EQ(parsed("log info --json " + folder.path("ros.log"))["channels"][0]["type"], "nav_msgs.Odometry");
}

// The path was 0 m and the rate 0 Hz.
TEST_F(Recordings, InfoMeasuresRowsThatWereWrittenLatestFirst) {
  std::ifstream in(folder.path("lidar.tum"));
  std::vector<std::string> rows;
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && line[0] != '#') rows.push_back(line);
  ASSERT_EQ(rows.size(), 400u);
  std::reverse(rows.begin(), rows.end());
  std::ofstream out(folder.path("descending.tum"));
  for (const std::string& row : rows) out << row << '\n';
  out.close();
  const json right = parsed("info --json " + folder.path("lidar.tum"))["streams"][0];
  const json descending = parsed("info --json " + folder.path("descending.tum"))["streams"][0];
  const double path = right["path_length_m"].get<double>();
  ASSERT_GT(path, 1);
  EXPECT_NEAR(descending["path_length_m"].get<double>(), path, 1e-9 * path);
  EXPECT_NEAR(descending["rate_hz"].get<double>(), right["rate_hz"].get<double>(), 1e-3);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(descending["turning_rad"][i].get<double>(), right["turning_rad"][i].get<double>(), 1e-9);
  for (const char* key : {"poses", "first_s", "last_s", "span_s", "gaps", "jumps"})
    EXPECT_EQ(descending[key], right[key]) << key;
  EXPECT_EQ(descending["times_not_increasing"], 399);
}

// It waited without a word for whatever was to write the pipe.
TEST_F(Recordings, WhatIsWaitedForIsSaidAfterASecond) {
  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string command =
      "timeout -k 9 3 " + paths::bin_dir() + "/egocal info " + pipe + " 2>" + folder.path("err");
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_EQ(read("err"), "egocal: waiting for data from " + pipe + "\n");
  // nothing where they come
  const std::string writer = "cat " + folder.path("lidar.tum") + " > " + pipe + " & ";
  ASSERT_EQ(std::system(writer.c_str()), 0);
  const Outcome fed = egocal("solve --json " + pipe + " " + folder.path("camera.tum"));
  EXPECT_EQ(fed.code, 0);
  EXPECT_EQ(fed.err, "");
}

// Commands that take FILE:CHANNEL as those that take a log: it was the line of the library.
TEST_F(Recordings, APackedLogOfLcmIsRefusedByEveryCommandWithTheSameLine) {
  const std::string log = folder.path("drive.log"), rig = folder.path("rig.toml");
  ASSERT_EQ(egocal("simulate --poses 20 --out " + log + " --rig-out " + rig).code, 0);
  const std::string file = folder.file("drive.log.zst", testing::packed("zstd", read("drive.log")));
  const std::string a = file + ":ODOMETRY_LIDAR ", b = file + ":ODOMETRY_CAMERA ", named = "--log " + file;
  for (const std::string& command :
       {"solve " + a + b, "check " + a + b, "align " + a + b, "compare " + a + b, "info " + file,
        "report " + a + b + "--out " + folder.path("page.html"),
        "log create " + rig + " --from lidar=" + a + "--from camera=" + b + "--out " + folder.path("new.log"),
        "solve " + named + " ODOMETRY_LIDAR ODOMETRY_CAMERA", "solve --rig " + rig + " " + named,
        "log info " + file, "export " + named, "up " + rig + " " + named}) {
    const Outcome run = egocal(command);
    EXPECT_EQ(run.code, 1) << command;
    EXPECT_EQ(run.out, "") << command;
    const std::string name = command.starts_with("up ") ? "egocal up" : "egocal";
    EXPECT_EQ(run.err,
              name + ": " + file + ": is packed by zstd, and a log is read unpacked: unzstd '" + file + "'\n")
        << command;
  }
}

}  // namespace
}  // namespace egocal::test_recordings
