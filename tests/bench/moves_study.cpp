// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How soon a moved mount is found, and how often a still one is called moved (docs/moves.md). Drives end a
// given time after a bump of half a degree and 3 cm about random axes; still ones last ten minutes, with
// white, heavy-tailed and wandering noise. Exit code 1 where a still mount raises an alarm.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "../support/random_motion.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/moves/find_moves.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/simulation/simulation.hpp"

namespace {

using namespace egocal;
using testing::Random;

constexpr double rate = 10;  // [Hz]
constexpr const char* noises[] = {"white", "heavy tails", "wandering"};

struct Options {
  int drives = 500;
  double before = 120;                              // [s]
  std::vector<double> after = {5, 10, 15, 20, 30};  // [s]
  double hours = 100;
  MovesOptions moves;
  std::uint64_t seed = 1;
};

SimulationOptions drive(Random& random, double seconds, int noise) {
  SimulationOptions options;
  options.terrain = random.uniform() < 0.5 ? Terrain::rough : Terrain::free;
  options.poses = static_cast<int>(rate * seconds) + 1;
  options.rate = rate;
  options.relative_noise = 0.01;
  options.heavy_tails = noise == 1;
  options.random_walk = noise == 2;
  options.seed = random.bits();
  options.T_vehicle_sensor = {Pose{}, to_pose(testing::random_extrinsic(random, 1))};
  options.faults.resize(2);
  return options;
}

/// As egocal does it: with single steps and with the stride that the drive chooses.
MovesResult moves_of(const SimulationOptions& options, const MovesOptions& moves) {
  const std::vector<Trajectory> sensors = simulate(options);
  PairingOptions pairing;
  const Choice choice = pair_motions(pairing, sensors[0], sensors[1]).drive.choice();
  pairing.balance = choice.balance;
  Problem problem;
  problem.balance = choice.balance;
  std::vector<std::vector<MotionPair>> strides;
  for (const int stride : {1, choice.stride}) {
    pairing.stride = stride;
    strides.push_back(pair_motions(pairing, sensors[0], sensors[1]).pairs);
  }
  return find_moves_of_strides(strides, problem, moves);
}

/// The share of bumps that are found this long after them [s], and the mean error of their time.
void find_bumps(const Options& options, double after, Random& random) {
  int found = 0, wrong = 0;
  double error = 0;
  for (int k = 0; k < options.drives; ++k) {
    SimulationOptions simulation = drive(random, options.before + after, 0);
    const double degrees = std::numbers::pi / 180;
    const MountChange bump{options.before,
                           options.before,
                           {rotation_exp(0.5 * degrees * random.direction()), 0.03 * random.direction()}};
    simulation.faults[1].mount_changes = {bump};
    const MovesResult result = moves_of(simulation, options.moves);
    bool here = false;
    for (const Move& move : result.moves) {
      const bool right = std::abs(move.time - options.before) < after;
      if (right && !here) error += std::abs(move.time - options.before);
      here = here || right;
      wrong += !right;
    }
    found += here;
  }
  std::printf(
      "bumps of 0.5 deg and 3 cm, %.0f s before the end: %d of %d found, %d at a wrong time, mean error %.1f "
      "s\n",
      after, found, options.drives, wrong, found > 0 ? error / found : 0);
}

int count_alarms(const Options& options, Random& random) {
  constexpr double seconds = 600;
  int alarms = 0;
  for (int noise = 0; noise < 3; ++noise) {
    const int drives = static_cast<int>(std::ceil(options.hours * 3600 / seconds / 3));
    int here = 0;
    for (int k = 0; k < drives; ++k)
      here += static_cast<int>(moves_of(drive(random, seconds, noise), options.moves).moves.size());
    std::printf("still mounts, %s noise: %d alarms in %.1f hours\n", noises[noise], here,
                drives * seconds / 3600);
    std::fflush(stdout);
    alarms += here;
  }
  return alarms;
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program app("moves_study",
                   "how soon a moved mount is found, and how often a still one is called moved; exit code 1 "
                   "where there is such an alarm");
  Options options;
  app.add_option("--drives", options.drives, "with a bump").show_default();
  app.add_option("--after", options.after, "times between the bump and the end of the drive [s]")
      .show_default();
  app.add_option("--before", options.before, "time before the bump [s]").show_default();
  app.add_option("--hours", options.hours, "of driving with a still mount").show_default();
  int blocks = static_cast<int>(options.moves.most_blocks);
  app.add_option("--blocks", blocks, "at most, that a drive is divided into").show_default();
  app.add_option("--chance", options.moves.false_alarms, "of a false alarm in a drive").show_default();
  app.add_option("--seed", options.seed, "of the drives").show_default();
  if (const auto code = app.parse(argc, argv)) return *code;
  options.moves.most_blocks = static_cast<std::size_t>(std::max(1, blocks));
  Random random(options.seed);
  if (options.drives > 0)
    for (const double after : options.after) {
      Random same(options.seed);  // the same drives, but for their length
      find_bumps(options, after, same);
    }
  return count_alarms(options, random) > 0 ? 1 : 0;
}
