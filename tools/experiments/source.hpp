// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "experiments/data_set.hpp"

namespace egocal::tools {

/// Where a data set comes from: two trajectory files, or a simulated drive where there are none.
struct Source {
  std::string file_a{}, file_b{};
  std::string times_a{}, times_b{};  ///< for KITTI files
  std::string truth{};               ///< "X,Y,Z,QW,QX,QY,QZ", empty where unknown
  std::string plane_a{}, plane_b{};  ///< "NX,NY,NZ,D"
  std::string weights = "equal";     ///< or "R:T"
  int stride = 1;
  double time_offset = 0;  ///< added to the stamps of b [s]

  int poses = 1001;               ///< of the simulated drive
  double noise = 0.01;            ///< relative
  std::string terrain = "rough";  ///< flat, rough or free
  std::uint64_t seed = 1;
};

/// Reads or simulates. Throws Error naming the file or the option that is wrong.
DataSet load(const Source& source);

}  // namespace egocal::tools
