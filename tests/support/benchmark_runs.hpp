// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The runs of the public benchmark in data_dir() (Valimaki, Garigipati and Ghabcheloo, Sensors 23(7):3740,
// 2023).
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "egocal/io/trajectory_file.hpp"
#include "paths.hpp"
#include "simulated_drive.hpp"

namespace egocal::testing {

inline Streams benchmark_run(const std::filesystem::path& folder) {
  Streams streams;
  streams.a = read_trajectory((folder / "a.tum").string());
  streams.b = read_trajectory((folder / "b.tum").string());
  std::ifstream truth(folder / "truth.txt");
  while (truth.peek() == '#') truth.ignore(1000, '\n');
  double t[3] = {}, q[4] = {};
  for (double& value : t) truth >> value;
  for (double& value : q) truth >> value;
  streams.T = to_dual_quaternion({Rotation(q[0], q[1], q[2], q[3]).normalized(), {t[0], t[1], t[2]}});
  return streams;
}

/// All runs of a level, such as "drift/drift_0.050000", by name.
inline std::vector<Streams> benchmark_runs(const std::string& level) {
  std::vector<std::filesystem::path> folders;
  for (const auto& entry : std::filesystem::directory_iterator(paths::data_dir() + "/tampere/" + level))
    folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  std::vector<Streams> runs;
  for (const std::filesystem::path& one : folders) runs.push_back(benchmark_run(one));
  return runs;
}

}  // namespace egocal::testing
