// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// How often the 95 % interval (1.96 reported standard deviations) covers the truth, per direction, with
// stride and weights chosen by the data: cars and free motion, white noise and noise that wanders, and one
// turn at the end of a drive. With --short, drives of 20 to 300 motions in five kinds of noise, cars in the
// plane as well.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "egocal/cli/cli.hpp"
#include "egocal/online/answer.hpp"
#include "support/one_turn_drive.hpp"
#include "support/random_motion.hpp"
#include "support/simulated_drive.hpp"
#include "uncertainty/frame_a.hpp"

namespace {

using namespace egocal;

struct Coverage {
  std::array<int, 6> observable{}, covered{};
};

constexpr const char* directions[] = {"x", "y", "z", "roll", "pitch", "yaw"};

void add_drive(const testing::Streams& streams, Coverage& coverage) {
  const Answer answer =
      solve(pair_motions(streams.options, streams.a, streams.b).drive.problem(), Method::dual);
  const auto error = detail::frame_a_difference(streams.T, answer.T_a_b);
  for (std::size_t i = 0; i < 6; ++i) {
    if (!answer.observability.observable[i] || !std::isfinite(answer.observability.stddev[i])) continue;
    ++coverage.observable[i];
    coverage.covered[i] +=
        std::abs(error[static_cast<Eigen::Index>(i)]) <= 1.96 * answer.observability.stddev[i];
  }
}

void print(const char* label, const Coverage& coverage) {
  std::printf("%-36s", label);
  for (std::size_t i = 0; i < 6; ++i)
    std::printf(" %5.1f %%", 100.0 * coverage.covered[i] / std::max(1, coverage.observable[i]));
  std::printf("\n");
}

enum class Noise { white, heavy_tails, wandering, on_poses, of_each_motion };
constexpr const char* noise_names[] = {"white", "heavy tails", "wandering", "on poses", "of each motion"};

struct Kind {
  const char* name;
  Terrain terrain;
  Mode mode;
};
constexpr Kind kinds[] = {{"car", Terrain::rough, Mode::spatial},
                          {"car in the plane", Terrain::flat, Mode::planar},
                          {"free motion", Terrain::free, Mode::spatial}};

GroundPlane ground_below(const Pose& T_vehicle_sensor) {
  return {T_vehicle_sensor.rotation.conjugate() * Eigen::Vector3d::UnitZ(),
          -T_vehicle_sensor.translation.z()};
}

/// White noise of all poses, of this part of the mean rotation and translation of a motion per axis.
void add_to_poses(double part, Trajectory& trajectory, testing::Random& random) {
  double turn = 0, shift = 0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Pose motion = to_pose(conjugate(trajectory[i - 1].pose) * trajectory[i].pose);
    turn += Eigen::AngleAxisd(motion.rotation).angle() / static_cast<double>(trajectory.size() - 1);
    shift += motion.translation.norm() / static_cast<double>(trajectory.size() - 1);
  }
  for (StampedPose& stamped : trajectory) {
    const Eigen::Vector3d rotation = random.normal3(part * turn), translation = random.normal3(part * shift);
    stamped.pose = normalized(stamped.pose * testing::displacement(rotation, translation));
  }
}

testing::Streams short_drive(const Kind& kind, Noise noise, int motions, std::uint64_t seed) {
  SimulationOptions options;
  options.terrain = kind.terrain;
  options.poses = motions + 1;
  options.seed = seed;
  options.random_walk = noise == Noise::wandering;
  options.heavy_tails = noise == Noise::heavy_tails;
  (noise == Noise::of_each_motion ? options.noise_of_motion : options.relative_noise) =
      noise == Noise::on_poses ? 0 : 0.01;
  testing::Streams streams = testing::simulated_drive(options);
  if (noise == Noise::on_poses) {
    constexpr double part = 0.02;  // the noise of a motion is then about that of the other kinds
    testing::Random random(seed);
    for (Trajectory* trajectory : {&streams.a, &streams.b}) add_to_poses(part, *trajectory, random);
  }
  streams.options.mode = kind.mode;
  if (kind.mode == Mode::planar) {
    streams.options.plane_a = ground_below(testing::T_vehicle_a);
    streams.options.plane_b = ground_below(testing::T_vehicle_b);
  }
  return streams;
}

void short_drives(int drives) {
  for (const Kind& kind : kinds)
    for (const Noise noise :
         {Noise::white, Noise::heavy_tails, Noise::wandering, Noise::on_poses, Noise::of_each_motion})
      for (const int motions : {20, 30, 50, 100, 300}) {
        Coverage coverage;
        for (int seed = 1; seed <= drives; ++seed)
          add_drive(short_drive(kind, noise, motions, 1000 + static_cast<std::uint64_t>(seed)), coverage);
        const std::string label = std::string(kind.name) + ", " + noise_names[static_cast<int>(noise)] +
                                  ", " + std::to_string(motions);
        print(label.c_str(), coverage);
      }
}

}  // namespace

int main(int argc, char** argv) {
  egocal::cli::Program app("coverage_study",
                           "how often the 95 % interval covers the truth; exit code 1 where it is not in 92 "
                           "to 98 % of the cases, by "
                           "more than the chance of a smaller number of drives explains");
  int drives = 500;
  app.add_option("--drives", drives, "simulated ones, in all [500]")
      .check(egocal::cli::Check::range(4, 1000000));
  int short_ones = 0;
  app.add_option("--short", short_ones, "print instead as many short drives of each kind and length [0]")
      .check(egocal::cli::Check::range(0, 1000000));
  if (const auto code = app.parse(argc, argv)) return *code;

  std::printf("%-36s", "");
  for (const char* direction : directions) std::printf(" %7s", direction);
  std::printf("\n");
  if (short_ones > 0) {
    short_drives(short_ones);
    return 0;
  }
  Coverage all;
  for (const Terrain terrain : {Terrain::rough, Terrain::free})
    for (const bool wanders : {false, true}) {
      Coverage here;
      for (int seed = 1; seed <= drives / 4; ++seed)
        add_drive(testing::simulated_drive({.terrain = terrain,
                                            .relative_noise = 0.01,
                                            .random_walk = wanders,
                                            .seed = static_cast<std::uint64_t>(seed)}),
                  here);
      for (std::size_t i = 0; i < 6; ++i) {
        all.observable[i] += here.observable[i];
        all.covered[i] += here.covered[i];
      }
      const std::string label = std::string(terrain == Terrain::rough ? "car, " : "free motion, ") +
                                (wanders ? "noise wanders" : "white noise");
      print(label.c_str(), here);
    }
  print("all", all);
  Coverage one_turn;
  for (int seed = 1; seed <= drives / 4; ++seed)
    add_drive(testing::one_turn_drive(static_cast<std::uint64_t>(seed)), one_turn);
  print("one turn at the end", one_turn);
  bool good = true;
  // of the default number of drives two standard errors below 92 %; height is hardly ever observable there
  for (const std::size_t i : {0u, 1u, 3u, 4u, 5u})
    good = good && one_turn.covered[i] >= 0.88 * one_turn.observable[i];
  for (std::size_t i = 0; i < 6; ++i) {
    const double part = static_cast<double>(all.covered[i]) / std::max(1, all.observable[i]);
    // by how much three standard deviations of a count are more than those of 500 drives
    const double slack =
        std::max(0.0, 3 * std::sqrt(0.05 * 0.95) * (1 / std::sqrt(drives) - 1 / std::sqrt(500)));
    good = good && part >= 0.92 - slack && part <= 0.98 + slack;
  }
  return good ? 0 : 1;
}
