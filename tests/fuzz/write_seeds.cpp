// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Good messages and logs, for the fuzzers to spoil: always of the layout that is being built.
//   write_seeds FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/scale.hpp"
#include "egocal/bus/verdict.hpp"
#include "support/bag_writer.hpp"

using namespace egocal;

namespace {

constexpr std::int64_t time_us = 1'600'000'000'000'000;

template <class Message>
void write(const std::filesystem::path& folder, const std::string& name, const Message& message) {
  std::filesystem::create_directories(folder);
  const std::vector<std::byte> bytes = bus::encode(message);
  std::ofstream(folder / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

StampedPose pose(int i) {
  return {time_us + 100'000 * i,
          to_dual_quaternion(Pose{rotation_exp({0.01 * i, 0.02, -0.03 * i}), {0.5 * i, -1.0, 0.25}})};
}

problem_t problem() {
  Problem problem;
  Statistics block;
  MotionPair pair;
  pair.a = pose(1).pose;
  pair.b = pose(2).pose;
  for (int row = 0; row < 8; ++row) block.dual_rows(row, row) = 1 + row;
  block.count = 10;
  block.weight = 10;
  problem.blocks = {block, block};
  problem.prior = pose(3).pose;
  problem_t message = bus::to_message(problem);
  message.utime = time_us;
  message.session = time_us;
  message.seq = 10;
  message.sensor_a = "lidar";
  message.sensor_b = "camera";
  message.choice = "fixed by the rig";
  message.host = "here";
  return message;
}

calibration_t calibration() {
  Answer answer;
  answer.T_a_b = pose(1).pose;
  answer.observability.hint = "turn";
  calibration_t message = bus::to_message(answer, problem());
  message.solver = "egocal-fast";
  return message;
}

scale_problem_t scale_problem() {
  ScaleProblem problem;
  std::vector<MotionPair> pairs;
  for (int i = 1; i < 40; ++i) pairs.push_back({pose(i).pose, pose(2 * i % 37).pose});
  problem.blocks = scale_blocks(pairs);
  scale_problem_t message = bus::to_message(problem);
  message.utime = message.session = time_us;
  message.sensor_a = "lidar";
  message.sensor_b = "camera";
  return message;
}

scale_t scale() {
  const scale_problem_t problem = scale_problem();
  const auto checked = bus::to_scale_problem(problem);
  scale_t message = bus::to_message(solve_scale(checked.value->blocks, checked.value->options), problem);
  message.solver = "egocal-global";
  return message;
}

verdict_t verdict() {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::contradictory;
  diagnosis.reason = "lengths of b times 2.7 fit";
  diagnosis.findings.resize(1);
  diagnosis.findings[0].code = "scale";
  diagnosis.findings[0].T_a_b = to_pose(pose(1).pose);
  diagnosis.goal.emplace().missing = {"z", "yaw"};
  verdict_t message = bus::to_message(diagnosis, {pose(1).pose, time_us, time_us, 10});
  message.utime = message.session = time_us;
  message.sensor_a = "lidar";
  message.sensor_b = "camera";
  message.sender = "egocal-diagnosis";
  return message;
}

status_t status() {
  status_t message{};
  message.utime = time_us;
  message.name = "egocal-pairing";
  message.role = "pairing";
  message.host = "here";
  message.version = "0";
  message.state = "running";
  message.n_counters = message.n_acknowledgements = 1;
  message.counters.resize(1);
  message.counters[0].name = "in";
  message.acknowledgements.resize(1);
  message.acknowledgements[0].channel = "ODOMETRY_LIDAR";
  return message;
}

/// Bags of a few messages of every type, without their magic bytes, which the fuzzers put before them.
void write_bag_seeds(const std::filesystem::path& folder) {
  using egocal::testing::MessageEncoder;
  const auto messages = [](MessageEncoder::Kind kind) {
    std::vector<egocal::testing::WrittenMessage> all;
    for (const char* type : {"nav_msgs/Odometry", "geometry_msgs/PoseStamped", "tf2_msgs/TFMessage"})
      for (int i = 0; i < 3; ++i)
        all.push_back({"/topic", type, pose(i).time_us, egocal::testing::encoded(kind, type, pose(i))});
    return all;
  };
  const auto write_seed = [&](const std::string& fuzzer, const std::string& name, const std::string& file,
                              std::size_t magic) {
    std::filesystem::create_directories(folder / fuzzer);
    std::ofstream(folder / fuzzer / name, std::ios::binary) << file.substr(magic);
  };
  for (const std::string compression : {"", "lz4", "zstd"})
    write_seed("mcap", "seed_" + compression,
               egocal::testing::mcap_file(messages(MessageEncoder::Kind::cdr), {compression, 4}), 8);
  write_seed("mcap", "seed_unchunked",
             egocal::testing::mcap_file(messages(MessageEncoder::Kind::cdr), {"", 0}), 8);
  for (const std::string compression : {"none", "lz4", "bz2"})
    write_seed("rosbag1", "seed_" + compression,
               egocal::testing::rosbag1_file(messages(MessageEncoder::Kind::ros1), {compression, 4}), 13);
  const std::string database = (folder / "seed.db3").string();
  egocal::testing::write_db3(database, messages(MessageEncoder::Kind::cdr), 512);
  std::ifstream stream(database, std::ios::binary);
  write_seed("database", "seed", {std::istreambuf_iterator<char>(stream), {}}, 16);
  std::filesystem::remove(database);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "write_seeds: expected a folder\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  odometry_t odometry = bus::to_message(pose(1), 1);
  write(folder / "odometry", "plain", odometry);
  odometry.covariance_size = 36;
  odometry.covariance.assign(36, 0.5);
  write(folder / "odometry", "with_covariance", odometry);
  write(folder / "pose", "plain", bus::to_pose_message(pose(1)));
  write(folder / "motion_pair", "plain", bus::to_message(MotionPair{pose(1).pose, pose(2).pose}));
  write(folder / "problem", "spatial", problem());
  problem_t planar = problem();
  planar.mode = 1;
  planar.plane_a[2] = planar.plane_b[2] = 1;
  write(folder / "problem", "planar", planar);
  problem_t touching = problem();
  touching.blocks.push_back(touching.blocks.back());
  touching.blocks.back().weight *= -0.5;
  for (double& entry : touching.blocks.back().q) entry *= -0.5;
  touching.n_blocks = 3;
  write(folder / "problem", "touching", touching);
  write(folder / "calibration", "plain", calibration());
  write(folder / "status", "plain", status());
  write(folder / "verdict", "plain", verdict());
  write(folder / "scale_problem", "plain", scale_problem());
  write(folder / "scale", "plain", scale());
  command_t command{};
  command.to = "*";
  command.verb = "reset";
  command.sensor_a = "lidar";
  command.sensor_b = "camera";
  write(folder / "command", "reset", command);

  std::filesystem::create_directories(folder / "log");
  for (const int events : {1, 4, 12}) {
    bus::LogWriter log(folder / "log" / (std::to_string(events) + "_events"));
    for (int i = 0; i < events; ++i)
      log.write(pose(i).time_us, i % 2 ? "ODO_LEFT" : "ODO_RIGHT",
                bus::encode(bus::to_message(pose(i), i / 2)));
    log.close();
  }
  write_bag_seeds(folder);
}
