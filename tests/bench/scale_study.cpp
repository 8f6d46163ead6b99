// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// solve_scale() against a search through all scales (docs/scale.md): small problems of every kind of motion,
// with noise up to twice the motions. What the search finds is evaluated in extended precision. Exit code 1
// where it is below the lower bound, or below a certified solution by more than its tolerance.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "../support/random_motion.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/scale/solve_scale.hpp"
#include "egocal/solvers/global.hpp"
#include "extended_reference.hpp"

namespace {

using namespace egocal;
using bench::Extended;
using testing::Motion;
using testing::Random;
using testing::RandomDrive;

struct Case {
  ScaleOptions options;
  std::vector<ScaleStatistics> blocks;
};

Case make_case(std::uint64_t seed) {
  Random random(seed);
  const Motion motions[] = {Motion::free, Motion::dominant_axis, Motion::planar, Motion::single_axis};
  Case result;
  RandomDrive drive;
  drive.motion = motions[seed % 4];
  drive.pairs = 12 + random.below(60);
  drive.noise = random.log_uniform(1e-4, 2);
  ScaleOptions& options = result.options;
  options.noise = static_cast<ScaleNoise>(seed / 4 % 3);
  options.mode = drive.motion == Motion::planar && seed % 8 < 4 ? Mode::planar : Mode::spatial;
  options.balance = {1, random.log_uniform(1e-2, 10)};
  const DualQuaternion T = options.mode == Mode::planar ? testing::random_planar_extrinsic(random)
                                                        : testing::random_extrinsic(random);
  const double scale = random.log_uniform(0.02, 50);
  std::vector<MotionPair> pairs = testing::random_pairs(T, drive, random);
  for (MotionPair& pair : pairs) pair.a = scaled(pair.a, 1 / scale);
  result.blocks = scale_blocks(pairs);
  return result;
}

/// The weights as the solution has them, extended to other scales.
Balance balance_at(double s, const ScaleSolution& solution, const ScaleOptions& options) {
  const double slope = options.noise == ScaleNoise::metric ? 0 : options.noise == ScaleNoise::both ? -1 : -2;
  Balance balance = options.balance;
  balance.translation = solution.balance.translation * std::pow(s / solution.scale, slope);
  return balance;
}

/// J in extended precision, of the statistics as they are and of q as projected on the constraints.
Extended exact_cost(const ScaleStatistics& all, double s, const DualQuaternion& q, const Balance& balance) {
  Extended r[4], d[4], rr = 0, rd = 0;
  for (int i = 0; i < 4; ++i) r[i] = q.real[i], rr += r[i] * r[i];
  for (int i = 0; i < 4; ++i) d[i] = q.dual[i], rd += r[i] * d[i];
  for (int i = 0; i < 4; ++i) d[i] -= rd / rr * r[i];
  Extended turned = 0, moved = 0;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k) {
      turned += r[i] * Extended(all.rotation(i, k)) * r[k];
      moved +=
          Extended(s) * r[i] * Extended(all.cross(i, k)) * r[k] +
          2 * r[i] * (Extended(all.coupling_b(i, k)) + Extended(s) * Extended(all.coupling_a(i, k))) * d[k] +
          d[i] * Extended(all.rotation(i, k)) * d[k];
    }
  moved += (Extended(all.square_b) + Extended(s) * Extended(s) * Extended(all.square_a)) * rr;
  return (Extended(balance.rotation) * turned + Extended(balance.translation) * moved) /
         (rr * Extended(all.weight));
}

/// The least cost over a grid of scales, refined around its best one.
Extended searched(const ScaleStatistics& all, const ScaleSolution& solution, const ScaleOptions& options) {
  const auto cost_at = [&](double s) {
    const Balance balance = balance_at(s, solution, options);
    const Matrix8d Q = cost_matrix(at_scale(all, s), balance);
    const DualQuaternion q = (options.mode == Mode::planar ? solve_planar(Q) : solve_dual(Q)).q;
    return exact_cost(all, s, q, balance);
  };
  double at = options.least;
  Extended best = cost_at(at);
  const auto look = [&](double s) {
    const Extended value = cost_at(s);
    if (value < best) best = value, at = s;
  };
  for (double log_s = std::log(options.least); log_s < std::log(options.most); log_s += 0.05)
    look(std::exp(log_s));
  look(options.most);
  for (double h = 0.02; h > 1e-9; h *= 0.6)
    for (const double s : {std::max(options.least, at * (1 - h)), std::min(options.most, at * (1 + h))})
      look(s);
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program app(
      "scale_study",
      "solutions with an unknown scale against a search through all scales; exit code 1 where the "
      "search is better");
  int problems = 100000;
  std::uint64_t seed = 1;
  app.add_option("--problems", problems, "to solve").show_default();
  app.add_option("--seed", seed, "of the first problem").show_default();
  if (const auto code = app.parse(argc, argv)) return *code;
  int certified = 0, observable = 0, below_bound = 0, better = 0;
  double solving = 0, most_solves = 0, worst = 0;
  for (int k = 0; k < problems; ++k) {
    const Case one = make_case(seed + static_cast<std::uint64_t>(k));
    const auto begin = std::chrono::steady_clock::now();
    const ScaleSolution solution = solve_scale(one.blocks, one.options);
    solving += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const ScaleStatistics all = sum_blocks(one.blocks);
    const Extended least = searched(all, solution, one.options);
    const Extended reached = exact_cost(all, solution.scale, solution.q, solution.balance);
    const double energy =
        solution.balance.translation * solution.scale * solution.scale * all.square_a / all.weight;
    const double tolerance = one.options.tolerance * energy + 2 * solution.rounding;
    certified += solution.certified;
    observable += solution.observable;
    most_solves = std::max<double>(most_solves, solution.solves);
    if (least < Extended(solution.lower_bound) - Extended(solution.rounding)) {
      ++below_bound;
      std::printf("problem %llu: the search is below the bound by %g\n",
                  static_cast<unsigned long long>(seed + static_cast<std::uint64_t>(k)),
                  static_cast<double>(Extended(solution.lower_bound) - least));
    }
    if (!solution.certified) continue;
    worst = std::max(worst, static_cast<double>(reached - least) / tolerance);
    if (reached - least > Extended(tolerance)) {
      ++better;
      std::printf("problem %llu: the search is better by %g, tolerance %g\n",
                  static_cast<unsigned long long>(seed + static_cast<std::uint64_t>(k)),
                  static_cast<double>(reached - least), tolerance);
    }
  }
  std::printf(
      "%d problems: %d certified, %d observable, at most %.0f solves; below the bound %d, better than a "
      "certified "
      "solution %d (at most %.2g of the tolerance); %.0f us a solution with its standard deviation\n",
      problems, certified, observable, most_solves, below_bound, better, worst,
      problems > 0 ? 1e6 * solving / problems : 0);
  return below_bound + better > 0 ? 1 : 0;
}
