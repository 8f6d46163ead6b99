// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A text through the reader of trajectories, whatever its format. After a zero byte: the file of times.
#include <algorithm>
#include <cmath>

#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "require.hpp"
#include "support/in_memory_file.hpp"

using namespace egocal;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const test::InMemoryFile poses, times;
  const std::uint8_t* const zero = std::find(data, data + size, 0);
  poses.set(data, static_cast<std::size_t>(zero - data));
  const bool with_times = zero != data + size;
  if (with_times) times.set(zero + 1, static_cast<std::size_t>(data + size - zero - 1));
  try {
    const Trajectory trajectory = read_trajectory(poses.name(), with_times ? times.name() : "");
    require(!trajectory.empty(), "a trajectory has a pose");
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
      const DualQuaternion& q = trajectory[i].pose;
      require(q.vec().allFinite(), "poses are finite");
      require(std::abs(q.real.norm() - 1) < 1e-9, "quaternions are of unit length");
      require(std::abs(q.real.dot(q.dual)) <= 1e-9 * (1 + q.dual.norm()),
              "real and dual part are orthogonal");
      require(i == 0 || trajectory[i].time_us > trajectory[i - 1].time_us, "times increase");
    }
  } catch (const Error& error) {
    fuzz::require_one_line(error.what());
  }
  return 0;
}
