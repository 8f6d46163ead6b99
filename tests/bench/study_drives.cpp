// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "study_drives.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "support/paths.hpp"
#include "support/real_drives.hpp"

namespace egocal::bench {

namespace {

using testing::Streams;

constexpr const char* terrain_names[] = {"flat", "rough", "free"};
constexpr const char* noise_names[] = {"white", "wandering", "heavy-tailed", "5 % outliers"};

Streams of_files(const std::string& folder, const char* a, const char* b) {
  return {{}, testing::real_trajectory(folder + a), testing::real_trajectory(folder + b), {}};
}

/// Every fourth run of each level, with the truth of the benchmark.
void add_tampere(std::vector<StudyDrive>& drives) {
  const std::filesystem::path root = paths::data_dir() + "/tampere";
  std::vector<std::filesystem::path> truths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
    if (entry.path().filename() == "truth.txt") truths.push_back(entry.path());
  std::sort(truths.begin(), truths.end());
  for (std::size_t i = 0; i < truths.size(); i += 4) {
    const std::string folder =
        std::filesystem::relative(truths[i].parent_path(), paths::data_dir()).string() + "/";
    Streams streams = of_files(folder, "a.tum", "b.tum");
    std::ifstream file(truths[i]);
    Pose T;
    double w = 1, x = 0, y = 0, z = 0;
    std::string comment;
    while ((file >> std::ws).peek() == '#') std::getline(file, comment);
    file >> T.translation[0] >> T.translation[1] >> T.translation[2] >> w >> x >> y >> z;
    T.rotation = Eigen::Quaterniond(w, x, y, z).normalized();
    streams.T = to_dual_quaternion(T);
    drives.push_back({folder, "tampere", std::move(streams), static_cast<bool>(file)});
  }
}

std::vector<StudyDrive> drives_of(const std::vector<double>& levels, int seeds, int poses, double rate_b,
                                  double speed_variation) {
  std::vector<StudyDrive> drives;
  for (int seed = 1; seed <= seeds; ++seed)
    for (const Terrain terrain : terrains)
      for (const double level : levels)
        for (const Noise noise : noises)
          drives.push_back(simulated_study_drive(terrain, level, noise, poses,
                                                 static_cast<std::uint64_t>(seed), rate_b, speed_variation));
  return drives;
}

}  // namespace

StudyDrive simulated_study_drive(Terrain terrain, double level, Noise noise, int poses, std::uint64_t seed,
                                 double rate_b, double speed_variation) {
  SimulationOptions options;
  options.terrain = terrain;
  options.speed_variation = speed_variation;
  options.relative_noise = level;
  options.random_walk = noise == Noise::wandering;
  options.heavy_tails = noise == Noise::heavy_tailed;
  options.poses = poses;
  options.seed = seed;
  options.faults.resize(2);
  if (noise == Noise::outliers) options.faults[1].outliers = 0.05;
  if (rate_b > 0) {
    options.faults[1].rate = rate_b;
    options.faults[1].phase = 0.37 / rate_b;
  }
  const std::string kind =
      std::string(terrain_names[static_cast<int>(terrain)]) + ", " + noise_names[static_cast<int>(noise)];
  char name[80];
  std::snprintf(name, sizeof name, "%s %.2g %%, %llu", kind.c_str(), 100 * level,
                static_cast<unsigned long long>(seed));
  return {name, kind, testing::simulated_drive(options)};
}

std::vector<StudyDrive> simulated_study_drives(int seeds, int poses, double rate_b) {
  return drives_of({0.001, 0.01, 0.1}, seeds, poses, rate_b, 0);
}

std::vector<StudyDrive> study_drives_of_speeds(int seeds, int poses, double rate_b) {
  constexpr double speeds = 1.5;  // see the declaration
  return drives_of({0.001, 0.01}, seeds, poses, rate_b, speeds);
}

StudyDrive drive_of_series(std::size_t i, int poses, double rate_b) {
  constexpr std::size_t kinds = std::size(terrains) * std::size(noises);
  // the golden ratio spreads the levels evenly over any stretch of the series
  constexpr double golden = 0.6180339887498949;
  const double part = std::fmod(golden * static_cast<double>(i / kinds), 1.0);
  return simulated_study_drive(terrains[i % std::size(terrains)], std::pow(10.0, -3 + 2 * part),
                               noises[i / std::size(terrains) % std::size(noises)], poses, 1000 + i, rate_b);
}

std::vector<StudyDrive> real_study_drives(bool few) {
  std::vector<StudyDrive> drives;
  if (!testing::have_real_drives()) return drives;
  drives.push_back({"KITTI 07", "KITTI", testing::kitti("07")});
  drives.push_back({"EuRoC", "EuRoC", testing::euroc()});
  if (few) return drives;
  drives.push_back({"KITTI 05", "KITTI", testing::kitti("05")});
  drives.push_back({"KITTI 05 a-loam", "KITTI", testing::kitti("05", "velodyne_aloam")});
  drives.push_back({"KITTI 07 a-loam", "KITTI", testing::kitti("07", "velodyne_aloam")});
  drives.push_back({"KITTI 0930", "KITTI", testing::kitti_asynchronous()});
  drives.push_back({"arm", "robot arm", testing::robot_arm()});
  const std::string tango = "eth_tango_easy/";
  drives.push_back({"tango c-m", "tango", of_files(tango, "caligula.tum", "mars.tum"), false});
  drives.push_back({"tango c-n", "tango", of_files(tango, "caligula.tum", "nero.tum"), false});
  drives.push_back({"tango m-n", "tango", of_files(tango, "mars.tum", "nero.tum"), false});
  add_tampere(drives);
  for (const char* name : {"fsuarez6", "moveit50", "aubo32", "scara", "visp_to-hand"}) {
    const std::string folder = std::string("hand_eye/") + name + "/";
    drives.push_back({name, "sets of poses as streams", of_files(folder, "hand.tum", "eye.tum"), false});
  }
  return drives;
}

}  // namespace egocal::bench
