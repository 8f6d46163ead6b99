// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Pairing's accumulation on its way to a file and back.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/odometry.hpp"
#include "egocal/error.hpp"
#include "egocal/simulation/simulation.hpp"
#include "pairing/accumulation_fields.hpp"
#include "pairing/saved_state.hpp"
#include "support/file_content.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::services {

struct Message {
  std::uint16_t channel;
  std::vector<std::byte> bytes;
};

inline bus::Rig rig(const std::string& type, const std::string& more = "") {
  return bus::parse_rig("[[sensor]]\nname = \"left\"\nchannel = \"L\"\ntype = \"" + type +
                            "\"\n[[sensor]]\nname = \"right\"\nchannel = \"R\"\ntype = \"" + type +
                            "\"\n[[pair]]\na = \"left\"\nb = \"right\"\n" + more,
                        "rig.toml");
}

inline std::vector<Message> drive(const std::string& type, int poses = 400) {
  SimulationOptions options;
  options.terrain = Terrain::free;
  options.poses = poses;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor = {Pose{}, Pose{rotation_exp({0.3, -0.2, 0.9}), {0.4, -0.8, 0.3}}};
  const std::vector<Trajectory> trajectories = simulate(options);
  std::vector<Message> messages;
  for (std::size_t i = 0; i < trajectories[0].size(); ++i)
    for (std::uint16_t k = 0; k < 2; ++k) {
      StampedPose pose = trajectories[k][i];
      pose.time_us += 1'600'000'000'000'000;
      messages.push_back({k, type == "bot_core.pose_t"
                                 ? bus::encode(bus::to_pose_message(pose))
                                 : bus::encode(bus::to_message(pose, static_cast<std::int64_t>(i)))});
    }
  return messages;
}

inline std::vector<std::byte> pair_bits(const Accumulation& accumulation) {
  Writer writer;
  writer(accumulation.pairs().front().state());
  return writer.bytes();
}

class SavedStates : public ::testing::Test {
 protected:
  void write_state(const bus::Rig& of, std::size_t messages) {
    const auto all = drive("egocal.odometry_t");
    SavedState saved(file, of);
    Accumulation accumulation = saved.restore();
    for (std::size_t i = 0; i < messages; ++i) {
      const Input input{Input::Kind::message, all[i].channel, all[i].bytes};
      saved.note(input);
      accumulation.apply(input);
      if (i % 16 == 15) saved.save(accumulation);
    }
    saved.save(accumulation);
  }
  std::string content() const { return testing::content_of(file); }
  void write(const std::string& bytes) const { std::ofstream(file, std::ios::binary) << bytes; }
  static std::string failure(SavedState& saved) {
    try {
      saved.restore();
      return "none";
    } catch (const Error& error) {
      return error.what();
    }
  }

  const testing::ScratchFolder scratch;
  const std::string folder = scratch.path().string(), file = scratch.path("pairing.state");
};

}  // namespace egocal::services
