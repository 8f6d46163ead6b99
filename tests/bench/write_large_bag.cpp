// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// A bag as large as a day of recording: a simulated drive of two sensors on /lidar and /camera among images
// that do not pack.
//   write_large_bag FILE GIGABYTES      writes MCAP with zstd where FILE ends in .mcap, else a ROS 1 bag with
//   lz4
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "egocal/simulation/simulation.hpp"
#include "support/bag_writer.hpp"
#include "support/random_motion.hpp"

using namespace egocal;
using namespace egocal::testing;

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: write_large_bag FILE GIGABYTES\n");
    return 2;
  }
  const std::string name = argv[1];
  const bool mcap = name.ends_with(".mcap");
  const auto parts = static_cast<std::size_t>(std::atof(argv[2]) * 64);  // of 16 MiB
  constexpr std::size_t poses_per_part = 100, images_per_part = 64;
  SimulationOptions options;
  options.poses = static_cast<int>(parts * poses_per_part);
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {Pose{}, {rotation_exp({0.3, -0.2, 1.0}), {0.5, -0.2, 0.3}}};
  auto drive = simulate(options);
  for (Trajectory& trajectory : drive)
    for (StampedPose& pose : trajectory) pose.time_us += 1'700'000'000'000'000;
  const auto kind = mcap ? MessageEncoder::Kind::cdr : MessageEncoder::Kind::ros1;
  Random random(1);
  std::string image(256 << 10, ' ');
  for (char& c : image) c = static_cast<char>(random.below(256));
  std::ofstream file(name, std::ios::binary);
  for (std::size_t part = 0; part < parts; ++part) {
    std::vector<WrittenMessage> messages;
    for (std::size_t i = 0; i < poses_per_part; ++i) {
      const std::size_t at = part * poses_per_part + i;
      messages.push_back({"/lidar", "nav_msgs/Odometry", drive[0][at].time_us,
                          encoded(kind, "nav_msgs/Odometry", drive[0][at])});
      messages.push_back({"/camera", "geometry_msgs/PoseStamped", drive[1][at].time_us,
                          encoded(kind, "geometry_msgs/PoseStamped", drive[1][at])});
      if (i < images_per_part)
        messages.push_back({"/image", "sensor_msgs/Image", drive[0][at].time_us, image});
    }
    // every part is a bag of its own; a reader takes bags that follow each other as one
    const std::string bytes = mcap ? mcap_file(messages, {"zstd", 10})
                                   : rosbag1_file(messages, {"lz4", 10}).substr(part == 0 ? 0 : 13);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  file.close();
  return file ? 0 : 1;
}
