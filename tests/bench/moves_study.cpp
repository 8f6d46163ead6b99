// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How soon a moved mount is found, and how often a still one is called moved (docs/moves.md). Every drive has
// a seed of its own and is one line of a record, so that hours of driving add up over several runs. Exit code
// 1 where a fixed mount raises an alarm.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../support/random_motion.hpp"
#include "drive_record.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/moves/find_moves.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/simulation/simulation.hpp"

namespace {

using namespace egocal;
using testing::Random;

constexpr double rate = 10;  // [Hz]
constexpr double degree = std::numbers::pi / 180;

/// A kind of drive: its length, its noise, and what happens to the mount of the second sensor.
struct Sort {
  const char* name;
  double seconds;
  bool heavy_tails = false, wandering = false;
  std::vector<double> bumps{};       ///< [s]
  double tolerance = 15;             ///< of a bump's time [s]
  double creep = 0;                  ///< [deg/h]
  bool jumps = false;                ///< the odometry's own
  Terrain terrain = Terrain::rough;  ///< or free, alternately, except for flat
  bool of_motion = false;            ///< noise is a part of each motion, and the speed varies
};

std::vector<Sort> sorts() {
  std::vector<Sort> all = {{"still-white", 600}, {"still-heavy", 600}, {"still-wandering", 600}};
  all[1].heavy_tails = all[2].wandering = true;
  all.push_back({"still-flat", 600});
  all.back().terrain = Terrain::flat;
  all.push_back({"still-jumps", 600});
  all.back().jumps = true;
  for (const auto& [name, seconds] :
       {std::pair{"still-30s", 30.0}, std::pair{"still-60s", 60.0}, std::pair{"still-120s", 120.0}})
    all.push_back({name, seconds});
  for (const auto& [name, after] : {std::pair{"bump-5s", 5.0}, std::pair{"bump-10s", 10.0},
                                    std::pair{"bump-15s", 15.0}, std::pair{"bump-20s", 20.0}}) {
    all.push_back({name, 120 + after});
    all.back().bumps = {120};
    all.back().tolerance = after;
  }
  for (const auto& [name, part] :
       {std::pair{"bump-20%", 0.2}, std::pair{"bump-50%", 0.5}, std::pair{"bump-80%", 0.8}}) {
    all.push_back({name, 240});
    all.back().bumps = {240 * part};
  }
  all.push_back({"three-bumps", 400});
  all.back().bumps = {100, 200, 300};
  all.push_back({"creep", 1200});
  all.back().creep = 2;
  // at the end, as the seed of a sort is that of its number
  const auto of_motion = [](Sort sort) {
    sort.of_motion = true;
    return sort;
  };
  all.push_back(of_motion({"still-of-motion", 200}));
  all.push_back(of_motion({.name = "still-of-motion-heavy", .seconds = 200, .heavy_tails = true}));
  all.push_back(of_motion({.name = "bump-of-motion", .seconds = 240, .bumps = {120}}));
  return all;
}

/// What one drive showed.
struct Outcome {
  int bumps = 0, found = 0, wrong = 0, creeps = 0;
  double error = 0;   ///< of the times of those found, their sum [s]
  double chance = 1;  ///< of the strongest evidence
};

SimulationOptions drive(const Sort& sort, Random& random) {
  SimulationOptions options;
  options.terrain = sort.terrain == Terrain::flat ? Terrain::flat
                    : random.uniform() < 0.5      ? Terrain::rough
                                                  : Terrain::free;
  options.poses = static_cast<int>(rate * sort.seconds) + 1;
  options.rate = rate;
  (sort.of_motion ? options.noise_of_motion : options.relative_noise) = 0.01;
  if (sort.of_motion) options.speed_variation = 1;
  options.heavy_tails = sort.heavy_tails;
  options.random_walk = sort.wandering;
  options.seed = random.bits();
  options.T_vehicle_sensor = {Pose{}, to_pose(testing::random_extrinsic(random, 1))};
  options.faults.resize(2);
  std::vector<MountChange>& changes = options.faults[1].mount_changes;
  for (const double time : sort.bumps)
    changes.push_back(
        {time, time, {rotation_exp(0.5 * degree * random.direction()), 0.03 * random.direction()}});
  if (sort.creep > 0)
    changes.push_back({0, 3600, {rotation_exp(sort.creep * degree * random.direction()), {0, 0, 0}}});
  if (sort.jumps)
    for (int i = 0; i < 3; ++i) {
      const double time = random.uniform(0, sort.seconds);
      const Pose jump{rotation_exp(random.normal3(0.1)), random.normal3(0.5)};
      options.faults[1].jumps.push_back({time, jump});
    }
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

Outcome outcome_of(const Sort& sort, Random random, const MovesOptions& options) {
  const MovesResult result = moves_of(drive(sort, random), options);
  Outcome outcome;
  outcome.bumps = static_cast<int>(sort.bumps.size());
  outcome.chance = result.chance;
  std::vector<bool> seen(sort.bumps.size());
  for (const Move& move : result.moves) {
    if (sort.creep > 0 && move.kind == MoveKind::creep) {
      ++outcome.creeps;
      continue;
    }
    bool right = false;
    for (std::size_t i = 0; i < sort.bumps.size() && !right; ++i) {
      const double error = std::abs(move.time - sort.bumps[i]);
      if (seen[i] || error > sort.tolerance) continue;
      seen[i] = right = true;
      ++outcome.found;
      outcome.error += error;
    }
    outcome.wrong += !right;
  }
  return outcome;
}

std::string to_line(const Outcome& o) {
  char line[160];
  std::snprintf(line, sizeof line, "%d %d %d %d %.3f %.6g", o.bumps, o.found, o.wrong, o.creeps, o.error,
                o.chance);
  return line;
}
std::optional<Outcome> from_line(const std::string* line) {
  Outcome o;
  if (line == nullptr || std::sscanf(line->c_str(), "%d %d %d %d %lf %lf", &o.bumps, &o.found, &o.wrong,
                                     &o.creeps, &o.error, &o.chance) != 6)
    return std::nullopt;
  return o;
}

/// Number of false alarms.
int report(const Sort& sort, const std::vector<Outcome>& outcomes) {
  int bumps = 0, found = 0, wrong = 0, creeps = 0, below[3] = {};
  double error = 0;
  for (const Outcome& o : outcomes) {
    bumps += o.bumps;
    found += o.found;
    wrong += o.wrong;
    creeps += o.creeps > 0;
    error += o.error;
    below[0] += o.chance < 0.1;
    below[1] += o.chance < 0.01;
    below[2] += o.chance < 0.001;
  }
  const int drives = static_cast<int>(outcomes.size());
  std::printf("%-16s %4d drives, %6.1f h: ", sort.name, drives, drives * sort.seconds / 3600);
  if (bumps > 0)
    std::printf("%d of %d bumps found, mean error %.1f s, %d at a wrong time\n", found, bumps,
                found > 0 ? error / found : 0, wrong);
  else if (sort.creep > 0)
    std::printf("%d called creeping, %d bumps\n", creeps, wrong);
  else
    std::printf("%d alarms; evidence below 0.1, 0.01, 0.001 in %d, %d, %d\n", wrong, below[0], below[1],
                below[2]);
  return bumps > 0 || sort.creep > 0 ? 0 : wrong;
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program app("moves_study",
                   "how soon a moved mount is found, and how often a still one is called moved; exit code 1 "
                   "where there is such an alarm");
  MovesOptions moves;
  int drives = 500, blocks = static_cast<int>(moves.most_blocks);
  double hours = 100;
  std::vector<std::string> only, names;
  const std::vector<Sort> all = sorts();
  for (const Sort& sort : all) names.push_back(sort.name);
  std::string path;
  std::uint64_t seed = 1;
  app.add_option("--drives", drives, "of each sort whose mount moves").show_default();
  app.add_option("--hours", hours,
                 "of driving with a still mount: a quarter of each noise and flat, and as "
                 "much as one of them with an odometry that jumps")
      .show_default();
  app.add_option("--only", only, "sorts of drives, such as still-white bump-15s creep")
      .check(egocal::cli::Check::one_of(names));
  app.add_option("--blocks", blocks, "at most, that a drive is divided into").show_default();
  app.add_option("--chance", moves.false_alarms, "of a false alarm in a drive").show_default();
  app.add_option("--seed", seed, "of the drives").show_default();
  app.add_option("--record", path, "file of one line a drive, which is continued");
  if (const auto code = app.parse(argc, argv)) return *code;
  moves.most_blocks = static_cast<std::size_t>(std::max(1, blocks));
  bench::DriveRecord record("moves_study", path,
                            "moves_study seed " + std::to_string(seed) + " blocks " + std::to_string(blocks) +
                                " chance " + std::to_string(moves.false_alarms));

  int alarms = 0;
  for (std::size_t s = 0; s < all.size(); ++s) {
    const Sort& sort = all[s];
    if (!only.empty() && std::find(only.begin(), only.end(), sort.name) == only.end()) continue;
    const bool still = sort.bumps.empty() && sort.creep == 0;
    const int count = still ? static_cast<int>(std::ceil(hours / 4 * 3600 / sort.seconds)) : drives;
    std::vector<Outcome> outcomes;
    for (int k = 0; k < count; ++k) {
      if (const std::optional<Outcome> known = from_line(record.known(sort.name, k))) {
        outcomes.push_back(*known);
        continue;
      }
      outcomes.push_back(outcome_of(sort, bench::random_of_drive(seed, s, k), moves));
      record.add(sort.name, k, to_line(outcomes.back()));
    }
    alarms += report(sort, outcomes);
    std::fflush(stdout);
  }
  return alarms > 0 ? 1 : 0;
}
