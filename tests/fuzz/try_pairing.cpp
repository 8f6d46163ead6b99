// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <array>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/rig.hpp"
#include "fuzz/input_bytes.hpp"
#include "fuzz/require.hpp"
#include "fuzz/try_sequence.hpp"
#include "pairing/accumulation_fields.hpp"

namespace egocal::fuzz {

namespace {

using services::Accumulation;
using services::Input;

const bus::Rig& rig() {
  static const bus::Rig value = bus::parse_rig(
      "[[sensor]]\nname = \"left\"\nchannel = \"L\"\n"
      "[[sensor]]\nname = \"right\"\nchannel = \"R\"\n"
      "[[sensor]]\nname = \"top\"\nchannel = \"T\"\ntype = \"bot_core.pose_t\"\n"
      "[[pair]]\na = \"left\"\nb = \"right\"\n"
      "[[pair]]\na = \"left\"\nb = \"top\"\ntime_offset = \"auto\"\n",
      "rig.toml");
  return value;
}

std::vector<std::byte> bits(const Accumulation& accumulation) {
  services::Writer writer;
  writer(accumulation.state());
  return writer.bytes();
}

Accumulation read_back(const Accumulation& accumulation) {
  const std::vector<std::byte> written = bits(accumulation);
  services::Reader reader(written);
  services::AccumulationState state;
  reader(state);
  require(reader.done(), "a state is read to its end");
  Accumulation other(rig());
  other.restore(std::move(state));
  require(bits(other) == written, "what was written and read back is the same");
  return other;
}

/// One odometry source that moves at random.
struct Source {
  std::int64_t time_us = 1'700'000'000'000'000, seq = 0;
  Pose pose;

  std::vector<std::byte> next(InputBytes& input, bool numbered) {
    time_us = input.near(time_us, 100'000);
    seq = input.near(seq, 1);
    pose.translation += Eigen::Vector3d(0.5, 0.01 * input.step(), 0);
    pose.rotation = pose.rotation * rotation_exp(Eigen::Vector3d(0.002, 0.001, 0.005) * input.step());
    pose.rotation.normalize();
    const StampedPose stamped{time_us, to_dual_quaternion(pose)};
    return numbered ? bus::encode(bus::to_message(stamped, seq)) : bus::encode(bus::to_pose_message(stamped));
  }
};

}  // namespace

void try_pairing(const std::uint8_t* data, std::size_t size) {
  InputBytes input(data, size);
  Accumulation accumulation(rig());
  std::array<Source, 3> sources;
  while (!input.done()) {
    const std::uint8_t choice = input.byte();
    const auto channel = static_cast<std::uint16_t>(choice % 3),
               pair = static_cast<std::uint16_t>(choice % 2);
    if (choice < 220) {
      std::vector<std::byte> message = sources[channel].next(input, channel != 2);
      if (choice >= 210) message[input.byte() % message.size()] ^= std::byte{0x10};
      accumulation.apply({Input::Kind::message, channel, message, 0});
    } else if (choice < 228) {
      accumulation.apply({choice < 223   ? Input::Kind::give_up
                          : choice < 226 ? Input::Kind::nothing_sent
                                         : Input::Kind::settled,
                          channel});
    } else if (choice < 234) {
      accumulation.apply({pair ? Input::Kind::patient : Input::Kind::impatient});
    } else if (choice < 240) {
      accumulation.apply({Input::Kind::new_session, pair});
    } else if (choice < 246) {
      accumulation.apply({choice < 244 ? Input::Kind::resume : Input::Kind::pause, pair});
    } else {
      accumulation = read_back(accumulation);
      if (choice < 250) accumulation.settle();
    }
    accumulation.take_motions();
  }
  for (services::PairSession& one : accumulation.pairs())
    if (const std::optional<problem_t> message = one.message())
      require(bool(bus::to_problem(*message)), "a problem that is sent is one that is taken");
  std::map<std::string, std::int64_t> counters;
  accumulation.count(counters);
  for (const auto& [name, value] : counters) require(value >= 0, "no count is negative");
}

}  // namespace egocal::fuzz
