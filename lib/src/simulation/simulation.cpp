// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/simulation/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <string>

#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/random.hpp"
#include "simulation/sensor.hpp"

namespace egocal {

namespace {

/// A sum of sinusoids with an amplitude of about one.
class Mixture {
 public:
  Mixture(Random& random, double shortest, double longest) {
    for (Wave& wave : waves_) {
      wave.frequency = 2 * std::numbers::pi / random.uniform(shortest, longest);
      wave.phase = random.uniform(0, 2 * std::numbers::pi);
    }
  }
  double at(double x) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(wave.frequency * x + wave.phase);
    return sum / std::sqrt(static_cast<double>(waves_.size()));
  }
  double slope(double x) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += wave.frequency * std::cos(wave.frequency * x + wave.phase);
    return sum / std::sqrt(static_cast<double>(waves_.size()));
  }

 private:
  struct Wave {
    double frequency = 0, phase = 0;
  };
  std::array<Wave, 4> waves_;
};

/// Poses of a vehicle (x forward, y left, z up) that follows a winding path on a surface.
std::vector<Pose> ground_path(const SimulationOptions& options, const std::vector<double>& times,
                              Random& random) {
  const Mixture curvature(random, 60, 300);  // over the length of the path [m]
  const Mixture along_x(random, 12, 40), along_y(random, 12, 40);
  Random of_speed(options.seed ^ 0xd6e8feb86659fd93ULL);
  const Mixture pace(of_speed, 10, 60);  // over the time [s]
  const double amplitude = options.terrain == Terrain::rough ? options.roughness : 0;
  constexpr double sharpest_turn = 0.04;  // [1/m]
  constexpr int substeps = 20;            // of the integration, between two poses
  std::vector<Pose> poses;
  double x = 0, y = 0, heading = 0, length = 0, time = 0;
  for (const double t : times) {
    const double speed = options.speed * std::max(0.0, 1 + options.speed_variation * pace.at(t));
    const double ds = speed * (t - time) / substeps;
    for (int i = 0; i < substeps; ++i) {
      const double turn = sharpest_turn * curvature.at(length + 0.5 * ds) * ds;
      x += ds * std::cos(heading + 0.5 * turn);
      y += ds * std::sin(heading + 0.5 * turn);
      heading += turn;
      length += ds;
    }
    time = t;
    // the surface z = amplitude (f(x) + g(y)): its normal, and the heading projected on it
    const Eigen::Vector3d normal =
        Eigen::Vector3d(-amplitude * along_x.slope(x), -amplitude * along_y.slope(y), 1).normalized();
    const Eigen::Vector3d left =
        normal.cross(Eigen::Vector3d(std::cos(heading), std::sin(heading), 0)).normalized();
    Eigen::Matrix3d R;
    R << left.cross(normal), left, normal;
    const double z = amplitude * (along_x.at(x) + along_y.at(y));
    poses.push_back({Eigen::Quaterniond(R).normalized(), Eigen::Vector3d(x, y, z)});
  }
  return poses;
}

/// Turns and moves in all directions.
std::vector<Pose> free_path(const SimulationOptions& options, const std::vector<double>& times,
                            Random& random) {
  std::vector<Mixture> turn, move;
  for (int i = 0; i < 3; ++i) {
    turn.emplace_back(random, 1.5, 6.0);  // [s]
    move.emplace_back(random, 2.0, 8.0);
  }
  constexpr double turn_rate = 0.6;  // [rad/s]
  constexpr int substeps = 20;       // of the integration, between two poses
  std::vector<Pose> poses;
  Pose pose;
  double time = 0;
  for (const double t : times) {
    const double dt = (t - time) / substeps;
    for (int i = 0; i < substeps; ++i) {
      const double now = time + (i + 0.5) * dt;
      const Eigen::Vector3d omega(turn[0].at(now), turn[1].at(now), turn[2].at(now));
      const Eigen::Vector3d velocity(move[0].at(now), move[1].at(now), move[2].at(now));
      pose = pose * Pose{rotation_exp(turn_rate * dt * omega), options.speed * dt * velocity};
    }
    time = t;
    poses.push_back(pose);
  }
  return poses;
}

void expect(bool good, const std::string& what) {
  if (!good) throw Error("simulation: expected " + what);
}

void expect_in(const Range& range, double value, const char* what) {
  if (range.contains(value)) return;
  char text[160];
  std::snprintf(text, sizeof text, "%s from %.10g to %.10g, got %.10g", what, range.least, range.most, value);
  expect(false, text);
}

void check(const SensorFaults& faults, double duration) {
  using namespace limits::simulation;
  if (faults.rate != 0) expect_in(rate, faults.rate, "a sensor's rate [Hz]");
  expect(faults.rate * duration <= poses.most, "a sensor's rate with at most 10000000 poses");
  expect_in({0, duration}, faults.phase, "a phase within the drive [s]");
  expect_in(scale, faults.scale, "a scale");
  expect_in(scale_drift, faults.scale_drift, "a scale drift [1/s]");
  expect_in(clock_offset, faults.clock_offset, "a clock offset [s]");
  expect_in(clock_drift, faults.clock_drift, "a clock drift [s/s]");
  expect_in(dropped, faults.dropped, "a share of dropped poses");
  expect_in(outliers, faults.outliers, "a share of outliers");
  expect_in(outlier_rotation, faults.outlier_rotation, "a rotation of outliers [rad]");
  expect_in(outlier_translation, faults.outlier_translation, "a translation of outliers [m]");
  expect_in(noise_factor, faults.noise_factor, "a noise factor");
}

void check(const SimulationOptions& options) {
  using namespace limits::simulation;
  expect_in(poses, options.poses, "a number of poses");
  expect_in(rate, options.rate, "a rate [Hz]");
  expect_in(speed, options.speed, "a speed [m/s]");
  expect_in(speed_variation, options.speed_variation, "a variation of the speed");
  expect_in(roughness, options.roughness, "a roughness [m]");
  for (const double of :
       {options.relative_noise, options.noise_of_motion, options.noise_rotation, options.noise_translation})
    expect_in(noise, of, "noise");
  const double duration = (options.poses - 1) / options.rate;
  expect(std::abs(options.speed) * (1 + options.speed_variation) * duration <= limits::largest_distance,
         "a drive of at most 1e9 m: fewer poses, a higher rate or a lower speed");
  expect(!options.T_vehicle_sensor.empty(), "at least one sensor");
  expect(options.faults.size() <= options.T_vehicle_sensor.size(), "no more faults than sensors");
  for (const SensorFaults& faults : options.faults) check(faults, duration);
}

}  // namespace

std::vector<Trajectory> simulate(const SimulationOptions& options) {
  check(options);
  Random random(options.seed);
  detail::Path path;
  for (int i = 0; i < options.poses; ++i) {
    path.stamps.push_back(std::llround(second_us * i / options.rate));
    path.times.push_back(to_seconds(path.stamps.back()));
  }
  path.poses = options.terrain == Terrain::free ? free_path(options, path.times, random)
                                                : ground_path(options, path.times, random);
  std::vector<Trajectory> trajectories;
  for (std::size_t k = 0; k < options.T_vehicle_sensor.size(); ++k) {
    trajectories.push_back(detail::drive_sensor(options, path, k, random));
    if (trajectories.back().empty())
      throw Error("simulation: sensor " + std::to_string(k + 1) +
                  " has no pose left: fewer dropped ones, or more of them");
  }
  return trajectories;
}

}  // namespace egocal
