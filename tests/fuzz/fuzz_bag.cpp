// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a bag behind the magic bytes of its kind: 1 MCAP, 2 ROS 1 bag, 3 rosbag2 database.
#include <cmath>
#include <string>
#include <type_traits>

#include "egocal/error.hpp"
#include "egocal/io/recording.hpp"
#include "require.hpp"
#include "support/in_memory_file.hpp"

using namespace egocal;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::conditional_t<EGOCAL_BAG_KIND == 3, test::NamedMemoryFile, test::InMemoryFile> file;
  const std::string magic[] = {{"\x89MCAP0\r\n", 8}, "#ROSBAG V2.0\n", {"SQLite format 3\0", 16}};
  std::string content = magic[EGOCAL_BAG_KIND - 1];
  content.append(reinterpret_cast<const char*>(data), size);
  file.set(content.data(), content.size());
  try {
    const auto recording = open_recording(file.name());
    recording->read("", [&](std::size_t stream, const StampedPose& pose) {
      require(stream < recording->streams().size(), "a pose belongs to a stream");
      require(pose.pose.vec().allFinite(), "poses are finite");
      require(std::abs(pose.pose.real.norm() - 1) < 1e-9, "quaternions are of unit length");
    });
  } catch (const Error& error) {
    fuzz::require_one_line(error.what());
  }
  return 0;
}
