// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/simulation/simulation.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <string>

#include "egocal/error.hpp"
#include "simulation/random.hpp"

namespace egocal {

namespace {

/// A sum of sinusoids with an amplitude of about one.
class Mixture {
 public:
  Mixture(detail::Random& random, double shortest, double longest) {
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
                              detail::Random& random) {
  const Mixture curvature(random, 60, 300);  // over the length of the path [m]
  const Mixture along_x(random, 12, 40), along_y(random, 12, 40);
  const double amplitude = options.terrain == Terrain::rough ? options.roughness : 0;
  constexpr double sharpest_turn = 0.04;  // [1/m]
  constexpr int substeps = 20;
  std::vector<Pose> poses;
  double x = 0, y = 0, heading = 0, length = 0, time = 0;
  for (const double t : times) {
    const double ds = options.speed * (t - time) / substeps;
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
                            detail::Random& random) {
  std::vector<Mixture> turn, move;
  for (int i = 0; i < 3; ++i) {
    turn.emplace_back(random, 1.5, 6.0);  // [s]
    move.emplace_back(random, 2.0, 8.0);
  }
  constexpr double turn_rate = 0.6;  // [rad/s]
  constexpr int substeps = 20;
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

void check(const SimulationOptions& options) {
  const auto expect = [](bool good, const char* what) {
    if (!good) throw Error(std::string("simulation: ") + what);
  };
  expect(options.poses >= 2, "expected at least 2 poses");
  expect(options.rate > 0 && options.rate <= 1e5, "expected a rate between 0 and 100000 Hz");
  expect(std::isfinite(options.speed), "expected a finite speed");
  expect(options.roughness >= 0 && std::isfinite(options.roughness), "expected a roughness of at least 0");
  expect(options.relative_noise >= 0 && options.noise_rotation >= 0 && options.noise_translation >= 0 &&
             std::isfinite(options.relative_noise + options.noise_rotation + options.noise_translation),
         "expected noise of at least 0");
  expect(!options.T_vehicle_sensor.empty(), "expected at least one sensor");
}

}  // namespace

std::vector<Trajectory> simulate(const SimulationOptions& options) {
  check(options);
  detail::Random random(options.seed);
  std::vector<std::int64_t> stamps;
  std::vector<double> times;
  for (int i = 0; i < options.poses; ++i) {
    stamps.push_back(std::llround(1e6 * i / options.rate));
    times.push_back(1e-6 * static_cast<double>(stamps.back()));
  }
  const std::vector<Pose> vehicle = options.terrain == Terrain::free ? free_path(options, times, random)
                                                                     : ground_path(options, times, random);
  std::vector<Trajectory> trajectories;
  for (const Pose& T_vehicle_sensor : options.T_vehicle_sensor) {
    const DualQuaternion mounting = to_dual_quaternion(T_vehicle_sensor);
    std::vector<DualQuaternion> motions;
    double rotation = 0, translation = 0;
    for (std::size_t i = 1; i < vehicle.size(); ++i) {
      const DualQuaternion motion = to_dual_quaternion(inverse(vehicle[i - 1]) * vehicle[i]);
      motions.push_back(canonical_sign(normalized(conjugate(mounting) * motion * mounting)));
      const Pose seen = to_pose(motions.back());
      rotation += rotation_log(seen.rotation).norm();
      translation += seen.translation.norm();
    }
    const double count = static_cast<double>(motions.size());
    const double sigma_r = options.noise_rotation + options.relative_noise * rotation / count;
    const double sigma_t = options.noise_translation + options.relative_noise * translation / count;

    constexpr std::int64_t epoch_us =
        1'700'000'000'000'000;  // a plausible date: times of zero are refused on the wire
    constexpr double correlation = 0.9;
    Trajectory trajectory;
    DualQuaternion pose;
    Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();
    trajectory.push_back({epoch_us + stamps[0], pose});
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const double keep = options.random_walk && i > 0 ? correlation : 0;
      turn = keep * turn + std::sqrt(1 - keep * keep) * sigma_r * random.normal3();
      shift = keep * shift + std::sqrt(1 - keep * keep) * sigma_t * random.normal3();
      DualQuaternion motion = motions[i];
      if (sigma_r > 0 || sigma_t > 0) motion = motion * to_dual_quaternion({rotation_exp(turn), shift});
      pose = canonical_sign(normalized(pose * motion));
      trajectory.push_back({epoch_us + stamps[i + 1], pose});
    }
    trajectories.push_back(std::move(trajectory));
  }
  return trajectories;
}

}  // namespace egocal
