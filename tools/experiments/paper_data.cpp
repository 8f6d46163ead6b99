// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <regex>
#include <sstream>

#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/simulation/simulation.hpp"
#include "experiments/paper_parts.hpp"
#include "experiments/paper_values.hpp"
#include "experiments/source.hpp"

namespace egocal::tools {

namespace {

std::string content_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file + ": cannot be opened for reading");
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// "tx ty tz qw qx qy qz" in the first line that is no comment.
Pose truth_in(const std::string& file) {
  std::istringstream lines(content_of(file));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    double v[7] = {};
    for (double& value : v) fields >> value;
    if (!fields) break;
    return {Eigen::Quaterniond(v[3], v[4], v[5], v[6]).normalized(), {v[0], v[1], v[2]}};
  }
  throw Error(file + ": expected a line tx ty tz qw qx qy qz");
}

/// {"normal": [x, y, z], "distance": d}, n . x = d with n up.
GroundPlane plane_in(const std::string& file) {
  const std::string text = content_of(file);
  static const std::regex number(R"([-+]?\d+\.?\d*(?:[eE][-+]?\d+)?)");
  std::vector<double> values;
  for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at)
    values.push_back(std::stod(at->str()));
  if (values.size() != 4) throw Error(file + ": expected a normal of three numbers and a distance");
  return validated(GroundPlane{{values[0], values[1], values[2]}, values[3]});
}

PaperData kitti(const std::string& folder) {
  Source source;
  source.file_a = folder + "/kitti_07/velodyne_pylidar.tum";
  source.file_b = folder + "/kitti_07/cam0_orbslam2.tum";
  source.truth = truth_in(folder + "/kitti_07/truth.txt");
  source.plane_a = plane_in(folder + "/kitti_ground_planes/ground_plane_04-11_velodyne.json");
  source.plane_b = plane_in(folder + "/kitti_ground_planes/ground_plane_04-11_cam0.json");
  PaperData data;
  data.online = load(source);
  data.online_name = "KITTI odometry 07, lidar odometry and ORB-SLAM2";
  source.file_a = folder + "/kitti_05/velodyne_pylidar.tum," + source.file_a;
  source.file_b = folder + "/kitti_05/cam0_orbslam2.tum," + source.file_b;
  data.table_2 = load(source);
  data.table_2_name = "KITTI odometry 05 and 07, lidar odometry and ORB-SLAM2";
  data.path = read_trajectory(folder + "/kitti_07/cam0_gt.tum");
  return data;
}

/// Two drives on a rough road where there are no real ones; the ground is that of the vehicle.
PaperData simulated() {
  PaperData data;
  Source source;
  source.noise = 0.02;
  source.poses = 1101;
  for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{2}}) {
    source.seed = seed;
    const DataSet drive = load(source);
    data.table_2.pairs.insert(data.table_2.pairs.end(), drive.pairs.begin(), drive.pairs.end());
    data.table_2.truth = drive.truth;
    data.online = drive;
  }
  data.table_2_name = data.online_name = "simulated drives on a rough road, 2 % noise (no --data was given)";
  SimulationOptions path;
  path.poses = 1101;
  data.path = simulate(path).front();
  return data;
}

}  // namespace

PaperData paper_data(const PaperOptions& options) {
  return options.data.empty() ? simulated() : kitti(options.data);
}

}  // namespace egocal::tools
