// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Simulated faults do what they say, to the sensor that they are of, and to no other.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "egocal/error.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/simulation/simulation.hpp"

namespace egocal::test_simulation {
namespace {

SimulationOptions two_sensors(Terrain terrain = Terrain::rough) {
  SimulationOptions options;
  options.terrain = terrain;
  options.poses = 401;
  options.T_vehicle_sensor = {Pose{rotation_exp({0.02, -0.01, 0.3}), {1, 0.2, 1.8}},
                              Pose{rotation_exp({-1.2, 0.1, -1.3}), {1.5, -0.4, 1.5}}};
  options.faults.resize(2);
  return options;
}

bool same(const Trajectory& x, const Trajectory& y) {
  if (x.size() != y.size()) return false;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i].time_us != y[i].time_us || x[i].pose.vec() != y[i].pose.vec()) return false;
  return true;
}

DualQuaternion motion(const Trajectory& trajectory, std::size_t from, std::size_t to) {
  return canonical_sign(normalized(conjugate(trajectory[from].pose) * trajectory[to].pose));
}

TEST(Simulation, NoFaultsAreNoFaults) {
  SimulationOptions plain = two_sensors();
  plain.relative_noise = 0.01;
  SimulationOptions without = plain;
  without.faults.clear();
  const auto x = simulate(plain), y = simulate(without);
  EXPECT_TRUE(same(x[0], y[0]) && same(x[1], y[1]));
}

TEST(Simulation, AFaultOfOneSensorLeavesTheOthers) {
  SimulationOptions options = two_sensors();
  options.T_vehicle_sensor.push_back({});
  options.relative_noise = 0.01;
  const auto plain = simulate(options);
  SensorFaults& faults = options.faults[1];
  faults.scale = 3;
  faults.rate = 17;
  faults.clock_offset = 0.2;
  faults.dropped = 0.1;
  faults.outliers = 0.1;
  faults.mount_changes.push_back({20, 20, {rotation_exp({0, 0, 0.1}), {0, 0, 0}}});
  const auto faulty = simulate(options), again = simulate(options);
  EXPECT_TRUE(same(plain[0], faulty[0]));
  EXPECT_TRUE(same(plain[2], faulty[2]));
  EXPECT_FALSE(same(plain[1], faulty[1]));
  EXPECT_TRUE(same(again[1], faulty[1]));
}

TEST(Simulation, ABumpChangesTheExtrinsicFromThenOn) {
  SimulationOptions options = two_sensors();
  options.faults[1].mount_changes.push_back({20.05, 20.05, {rotation_exp({0, 0.02, 0}), {0.05, 0, 0}}});
  const auto drive = simulate(options);
  for (const auto& [from, to, time] : {std::tuple{0, 200, 10.0}, std::tuple{201, 400, 30.0}}) {
    const DualQuaternion T = to_dual_quaternion(true_extrinsic(options, 0, 1, time));
    const DualQuaternion a = motion(drive[0], static_cast<std::size_t>(from), static_cast<std::size_t>(to));
    const DualQuaternion b = motion(drive[1], static_cast<std::size_t>(from), static_cast<std::size_t>(to));
    EXPECT_LT(extrinsic_error(a, T * b * conjugate(T)).translation, 1e-9);
  }
  const Pose before = true_extrinsic(options, 0, 1, 20), after = true_extrinsic(options, 0, 1, 21);
  EXPECT_NEAR(rotation_log(before.rotation.conjugate() * after.rotation).norm(), 0.02, 1e-12);
}

TEST(Simulation, CreepIsHalfDoneHalfWay) {
  SimulationOptions options = two_sensors();
  options.faults[0].mount_changes.push_back({10, 30, {rotation_exp({0, 0, 0.04}), {0, 0.1, 0}}});
  const Pose whole = true_extrinsic(options, 0, 1, 0), half = true_extrinsic(options, 0, 1, 20);
  EXPECT_NEAR(rotation_log(whole.rotation.conjugate() * half.rotation).norm(), 0.02, 1e-12);
}

TEST(Simulation, ScaleDividesTheTranslations) {
  SimulationOptions options = two_sensors(Terrain::free);
  const auto plain = simulate(options);
  options.faults[1].scale = 4;
  const auto faulty = simulate(options);
  for (std::size_t i = 0; i < plain[1].size(); ++i) {
    EXPECT_LT((plain[1][i].pose.dual - 4 * faulty[1][i].pose.dual).norm(), 1e-9);
    EXPECT_LT((plain[1][i].pose.real - faulty[1][i].pose.real).norm(), 1e-12);
  }
}

TEST(Simulation, ClocksOfOneSensorRunOff) {
  SimulationOptions options = two_sensors();
  const auto plain = simulate(options);
  options.faults[1].clock_offset = -0.25;
  options.faults[1].clock_drift = 1e-3;
  const auto faulty = simulate(options);
  EXPECT_EQ(faulty[1].front().time_us - plain[1].front().time_us, -250'000);
  EXPECT_EQ(faulty[1].back().time_us - plain[1].back().time_us, -250'000 + 40'000);
}

TEST(Simulation, SensorsOfTheirOwnRateRideTheSamePath) {
  SimulationOptions options = two_sensors();
  options.faults[1].rate = 23;
  options.faults[1].phase = 0.013;
  const auto drive = simulate(options);
  EXPECT_NEAR(static_cast<double>(drive[1].size()), 40 * 23, 2);
  // a sensor of the drive's rate, at times that both have: none but nearly so; the ends agree to a motion
  const DualQuaternion T = to_dual_quaternion(true_extrinsic(options, 0, 1));
  const DualQuaternion a = motion(drive[0], 0, 400);
  const DualQuaternion b = motion(drive[1], 0, drive[1].size() - 1);
  EXPECT_LT(extrinsic_error(a, T * b * conjugate(T)).translation, 1.0);
}

TEST(Simulation, AJumpIsOneMotionThatIsNotThere) {
  SimulationOptions options = two_sensors();
  const auto plain = simulate(options);
  options.faults[1].jumps.push_back({20.05, {rotation_exp({0, 0, 0.3}), {2, 0, 0}}});
  const auto faulty = simulate(options);
  for (std::size_t i = 1; i < plain[1].size(); ++i) {
    const double difference =
        extrinsic_error(motion(plain[1], i - 1, i), motion(faulty[1], i - 1, i)).translation;
    EXPECT_EQ(difference > 1e-9, i == 201) << i;
  }
}

TEST(Simulation, HeavyTailsHaveTheSameSizeAndLargerExtremes) {
  SimulationOptions options = two_sensors();
  options.poses = 20001;
  const auto perfect = simulate(options);
  options.noise_translation = 0.01;
  const auto sizes = [&](bool heavy) {
    options.heavy_tails = heavy;
    const auto drive = simulate(options);
    double squares = 0, largest = 0;
    for (std::size_t i = 1; i < drive[0].size(); ++i) {
      const double size =
          extrinsic_error(motion(perfect[0], i - 1, i), motion(drive[0], i - 1, i)).translation;
      squares += size * size;
      largest = std::max(largest, size);
    }
    return std::pair(std::sqrt(squares / 3 / static_cast<double>(drive[0].size() - 1)), largest);
  };
  const auto normal = sizes(false), heavy = sizes(true);
  EXPECT_NEAR(normal.first, 0.01, 0.001);
  EXPECT_NEAR(heavy.first, 0.01, 0.003);
  EXPECT_GT(heavy.second, 3 * normal.second);
}

TEST(Simulation, DroppedAndWrongPosesAreAsManyAsAskedFor) {
  SimulationOptions options = two_sensors();
  options.poses = 10001;
  const auto plain = simulate(options);
  options.faults[1].dropped = 0.2;
  EXPECT_NEAR(static_cast<double>(simulate(options)[1].size()) / 10001, 0.8, 0.02);
  options.faults[1].dropped = 0;
  options.faults[1].outliers = 0.05;
  const auto faulty = simulate(options);
  int wrong = 0;
  for (std::size_t i = 0; i < plain[1].size(); ++i)
    wrong += plain[1][i].pose.vec() != faulty[1][i].pose.vec();
  EXPECT_NEAR(wrong / 10001.0, 0.05, 0.01);
}

TEST(Simulation, ValuesOutOfRangeAreRefused) {
  const auto refused = [](auto change) {
    SimulationOptions options = two_sensors();
    change(options.faults[1]);
    EXPECT_THROW(simulate(options), Error);
  };
  refused([](SensorFaults& faults) { faults.scale = 0; });
  refused([](SensorFaults& faults) { faults.scale = std::nan(""); });
  refused([](SensorFaults& faults) { faults.dropped = 1; });
  refused([](SensorFaults& faults) { faults.outliers = -0.1; });
  refused([](SensorFaults& faults) { faults.rate = -1; });
  refused([](SensorFaults& faults) { faults.clock_drift = 1; });
  refused([](SensorFaults& faults) { faults.noise_factor = std::nan(""); });
  refused([](SensorFaults& faults) { faults.phase = 1e6; });
  refused([](SensorFaults& faults) { faults.rate = 1e-300; });
  const auto refused_drive = [](auto change) {
    SimulationOptions options = two_sensors();
    change(options);
    EXPECT_THROW(simulate(options), Error);
  };
  refused_drive([](SimulationOptions& options) { options.faults.resize(3); });
  refused_drive([](SimulationOptions& options) { options.rate = 1e-300; });
  refused_drive([](SimulationOptions& options) { options.speed = 1e300; });
  refused_drive([](SimulationOptions& options) { options.roughness = 1e300; });
  // a drive of ten million kilometres, a sensor without a pose
  refused_drive(
      [](SimulationOptions& options) { options.rate = 0.001, options.speed = 1000, options.poses = 10001; });
  refused_drive([](SimulationOptions& options) { options.poses = 2, options.faults[0].dropped = 0.999; });
  refused_drive([](SimulationOptions& options) { options.noise_rotation = 1e4; });
  refused([](SensorFaults& faults) { faults.dropped = 0.9999; });
}

}  // namespace
}  // namespace egocal::test_simulation
