// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// The paths of the public benchmark with new draws of its noise: 13 runs a level are too few to say how often
// 1.96 standard deviations cover the truth. The table of docs/intervals.md.
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "egocal/cli/cli.hpp"
#include "egocal/online/answer.hpp"
#include "markdown_tables.hpp"
#include "support/benchmark_runs.hpp"
#include "support/random_motion.hpp"
#include "support/real_drives.hpp"
#include "uncertainty/frame_a.hpp"

namespace {

using namespace egocal;
using testing::Random;

/// White noise of all poses of both sensors; in the mixture also lasting jumps and the benchmark's drift of
/// b.
struct Level {
  const char* name;
  double noise;  ///< standard deviation in metres, twice as many radians
  double jumps;  ///< part of the steps of b
  bool drift;
};
constexpr Level levels[] = {
    {"noise on poses .002", 0.002, 0, false},
    {"noise on poses .010", 0.010, 0, false},
    {"mixture", 0.005, 0.05, true},
    {"mixture without its drift", 0.005, 0.05, false},
};
constexpr double jump = 0.2;  // [m]

void add_noise(double metres, Trajectory& trajectory, Random& random) {
  for (StampedPose& stamped : trajectory)
    stamped.pose = normalized(stamped.pose * testing::normal_displacement(random, 2 * metres, metres));
}

testing::Streams redrawn(const testing::Streams& run, const Level& level, Random& random) {
  testing::Streams streams = run;  // a has no error, b has drift
  Trajectory& b = streams.b;
  DualQuaternion jumped;
  for (std::size_t i = 0; i < b.size(); ++i) {
    if (!level.drift) b[i].pose = streams.a[i].pose * run.T;
    if (i > 0 && random.uniform() < level.jumps)
      jumped = jumped * testing::displacement({0, 0, 0}, jump * random.direction());
    b[i].pose = jumped * b[i].pose;
  }
  add_noise(level.noise, streams.a, random);
  add_noise(level.noise, b, random);
  return streams;
}

std::string percent(double part, double of) {
  char text[20];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * part / of);
  return text;
}

std::vector<std::string> row_of(const Level& level, int draws, std::uint64_t seed) {
  std::array<double, 6> all{}, covered{};
  double squares = 0, count = 0, sum = 0;
  Random random(seed);
  for (const testing::Streams& run : testing::benchmark_runs("drift/drift_0.050000"))
    for (int draw = 0; draw < draws; ++draw) {
      const testing::Streams streams = redrawn(run, level, random);
      const Answer answer =
          solve(pair_motions(streams.options, streams.a, streams.b).drive.problem(), Method::dual);
      const auto error = detail::frame_a_difference(streams.T, answer.T_a_b);
      for (std::size_t k = 0; k < 6; ++k) {
        const double stddev = answer.observability.stddev[k];
        if (!answer.observability.observable[k] || !std::isfinite(stddev)) continue;
        const double ratio = std::abs(error[static_cast<Eigen::Index>(k)]) / stddev;
        all[k] += 1;
        covered[k] += ratio <= 1.96;
        sum += ratio <= 1.96;
        squares += ratio * ratio;
        count += 1;
      }
    }
  std::vector<std::string> row{level.name, percent(sum, count)};
  for (std::size_t k = 0; k < 6; ++k) row.push_back(percent(covered[k], all[k]));
  char ratio[20];
  std::snprintf(ratio, sizeof ratio, "%.2f", std::sqrt(count / squares));
  row.emplace_back(ratio);
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program app("redrawn_study", "coverage on the benchmark's paths with new draws of its noise");
  int draws = 40;
  std::uint64_t seed = 1;
  std::string write;
  app.add_option("--draws", draws, "of the noise of each path")
      .check(cli::Check::range(1, 10000))
      .show_default();
  app.add_option("--seed", seed, "of the draws").show_default();
  app.add_option("--write", write, "a page: put the table in its place");
  if (const auto code = app.parse(argc, argv)) return *code;
  if (!testing::have_real_drives()) return bench::not_compared;
  bench::Table table{"redrawn",
                     {{"level", "covered", "x", "y", "z", "roll", "pitch", "yaw", "sigma / error"}}};
  for (const Level& level : levels) table.rows.push_back(row_of(level, draws, seed));
  return bench::publish(table, write, "");
}
