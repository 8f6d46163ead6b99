// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/drive.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/bus/convert.hpp"
#include "egocal/simulation/simulation.hpp"
#include "simulation/host.hpp"
#include "support/mistakes.hpp"
#include "support/random_motion.hpp"

namespace egocal::simulation {

namespace {

/// Two degrees and five centimetres.
const Pose bump{rotation_exp({0, 0.035, 0}), {0.05, 0, 0}};

constexpr std::uint32_t log_sync = 0xEDA1DA01;

void big_endian(std::vector<std::byte>& out, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out.push_back(std::byte(value >> (8 * i) & 0xff));
}

void append_event(std::vector<std::byte>& log, std::uint64_t number, std::int64_t time_us,
                  const std::string& channel, const std::vector<std::byte>& data) {
  big_endian(log, log_sync, 4);
  big_endian(log, number, 8);
  big_endian(log, static_cast<std::uint64_t>(time_us), 8);
  big_endian(log, channel.size(), 4);
  big_endian(log, data.size(), 4);
  for (const char c : channel) log.push_back(std::byte(c));
  log.insert(log.end(), data.begin(), data.end());
}

bus::Rig make_rig(const Plan& plan) {
  std::string text;
  for (int i = 0; i < plan.sensors; ++i)
    text += "[[sensor]]\nname = \"s" + std::to_string(i) + "\"\nchannel = \"ODOMETRY_" + std::to_string(i) +
            "\"\ntype = \"" + (plan.numbered ? "egocal.odometry_t" : "bot_core.pose_t") +
            (plan.auto_scale && i == 1 ? "\"\nscale = \"auto" : "") + "\"\n";
  const std::string settings = plan.estimation == Estimation::plain    ? "weights = \"equal\"\n"
                               : plan.estimation == Estimation::robust ? "stride = 1\nweights = [1, 0.1]\n"
                                                                       : "";
  for (int i = 1; i < plan.sensors; ++i)
    text += "[[pair]]\na = \"s0\"\nb = \"s" + std::to_string(i) + "\"\n" + settings;
  return bus::parse_rig(text, "rig.toml");
}

/// What a person did to the streams of the first pair.
void make_mistake(int number, std::vector<Trajectory>& trajectories, std::vector<DualQuaternion>& truth) {
  const testing::Mistake mistake = testing::mistakes()[static_cast<std::size_t>(number)];
  testing::Streams streams;
  streams.a = std::move(trajectories[0]);
  streams.b = std::move(trajectories[1]);
  const Trajectory before = streams.b;
  mistake.make(streams);
  if (mistake.code == "mount_moved")
    truth.push_back(truth.front() * (conjugate(before.back().pose) * streams.b.back().pose));
  trajectories[0] = std::move(streams.a);
  trajectories[1] = std::move(streams.b);
}

}  // namespace

Drive make_drive(const Plan& plan) {
  Drive drive;
  drive.rig = make_rig(plan);
  testing::Random random(plan.seed * 3);
  SimulationOptions options;
  options.seed = random.bits() >> 1;
  options.rate = plan.rate_hz;
  options.poses = static_cast<int>(
      std::lround(1e-6 * static_cast<double>(plan.disturbed_us + plan.quiet_us) * plan.rate_hz));
  options.terrain = plan.free_motion ? Terrain::free : Terrain::rough;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor.clear();
  for (int i = 0; i < plan.sensors; ++i) {
    options.T_vehicle_sensor.push_back({rotation_exp(random.normal3(0.8)), random.normal3(1)});
    SensorFaults& faults = options.faults.emplace_back();
    const double phase = random.uniform(0, 0.5 / plan.rate_hz);
    faults.phase = plan.measured_together() && i < 2 ? 0 : phase;
    if (i != 1) continue;
    faults.scale = plan.scale;
    faults.clock_drift = plan.clock_drift;
    if (plan.bump_s > 0) faults.mount_changes = {{plan.bump_s, 0, bump}};
  }
  std::vector<Trajectory> trajectories = simulate(options);
  for (std::size_t i = 1; i < trajectories.size(); ++i)
    drive.truth.push_back({to_dual_quaternion(true_extrinsic(options, 0, i))});
  if (plan.mistake > 0) make_mistake(plan.mistake, trajectories, drive.truth.front());
  for (std::size_t i = 0; i < trajectories.size(); ++i)
    for (std::size_t k = 0; k < trajectories[i].size(); ++k) {
      const StampedPose& pose = trajectories[i][k];  // from HostClock::start_of_all_us on
      drive.messages.push_back({pose.time_us, i,
                                plan.numbered
                                    ? bus::encode(bus::to_message(pose, static_cast<std::int64_t>(k)))
                                    : bus::encode(bus::to_pose_message(pose))});
    }
  std::stable_sort(drive.messages.begin(), drive.messages.end(),
                   [](const Message& x, const Message& y) { return x.time_us < y.time_us; });
  std::uint64_t number = 0;
  for (const Message& message : drive.messages)
    append_event(drive.log, number++, message.time_us, drive.rig.sensors[message.channel].channel,
                 message.bytes);
  return drive;
}

}  // namespace egocal::simulation
