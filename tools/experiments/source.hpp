// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "egocal/io/recording.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/simulation/simulation.hpp"
#include "experiments/data_set.hpp"

namespace egocal::tools {

/// Where a data set comes from: two trajectory files, several drives of one rig between commas (A1,A2 and
/// B1,B2), or a simulated drive where there are none.
struct Source {
  std::string file_a{}, file_b{};
  ReadOptions reading_a{}, reading_b{};
  /// Reads a trajectory: what the library knows, or more.
  std::function<TrajectoryReading(const std::string& name, const ReadOptions&)> read = read_trajectory_file;
  std::optional<Pose> truth{};  ///< pose of sensor b in sensor a, where known
  std::optional<GroundPlane> plane_a{}, plane_b{};
  Balance balance{};
  int stride = 1;          ///< steps of the slower stream in one motion
  double time_offset = 0;  ///< added to the stamps of b [s]

  int poses = 1001;     ///< of the simulated drive
  double noise = 0.01;  ///< relative to the mean motion
  Terrain terrain = Terrain::rough;
  std::uint64_t seed = 1;
};

/// Reads or simulates. Throws Error naming the file at fault.
DataSet load(const Source& source);

}  // namespace egocal::tools
