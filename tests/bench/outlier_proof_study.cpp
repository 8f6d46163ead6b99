// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// prove_outliers(): never wrongly, against the search through all choices on 16 blocks; how often it proves
// the choice on drives of 64 blocks, and how long it takes. The tables of docs/method.md, "Outliers".
#include <chrono>
#include <cstdio>

#include "egocal/cli/cli.hpp"
#include "support/truncated_problems.hpp"

namespace {

using namespace egocal;
using testing::Random;
using testing::TruncatedDrive;
using testing::TruncatedProblem;

struct Tally {
  std::size_t problems = 0, proven = 0, not_best = 0, wrongly_proven = 0, wrongly_refuted = 0;
};

/// The choice that is settled from the right one, or from anything: local minima on purpose.
std::optional<std::vector<bool>> some_choice(const TruncatedProblem& problem, Random& random) {
  std::vector<bool> start = problem.wrong;
  if (random.uniform() < 0.5)
    for (std::size_t k = 0; k < start.size(); ++k) start[k] = random.uniform() < 0.6;
  return testing::settled_choice(problem.parts, std::move(start));
}

TruncatedDrive any_drive(Random& random) {
  TruncatedDrive drive;
  constexpr testing::Motion motions[] = {testing::Motion::free, testing::Motion::dominant_axis,
                                         testing::Motion::planar, testing::Motion::single_axis};
  drive.motion = motions[random.below(4)];
  drive.outliers = random.uniform(0, 0.45);
  drive.outlier_size = random.log_uniform(0.003, 0.5);
  drive.noise = random.log_uniform(0.001, 0.3);
  drive.limit = random.log_uniform(1.2, 60);
  drive.motions_per_block = 1 + random.below(16);
  return drive;
}

Tally against_all_choices(std::size_t problems, std::uint64_t seed) {
  Tally tally;
  Random random(seed);
  while (tally.problems < problems) {
    const TruncatedProblem problem = testing::truncated_problem(any_drive(random), random);
    const auto choice = some_choice(problem, random);
    if (!choice) continue;
    const OutlierProof proof = prove_outliers(problem.parts, *choice);
    ++tally.problems;
    if (proof.choice == OutlierChoice::not_proven) continue;
    const double given =
        testing::truncated_cost(problem.parts, testing::minimum_without(problem.parts, *choice));
    const double least = testing::AllChoices(problem.parts, given).least();
    const bool best = least >= given * (1 - 1e-8);
    if (proof.choice == OutlierChoice::proven) {
      ++tally.proven;
      tally.wrongly_proven += best ? 0 : 1;
    } else {
      ++tally.not_best;
      tally.wrongly_refuted += best ? 1 : 0;
    }
  }
  return tally;
}

void proven_part(testing::Motion motion, const char* name, double outliers, std::size_t drives) {
  std::size_t proven = 0, decided_at_once = 0, better = 0;
  double seconds = 0, longest = 0;
  Random random(static_cast<std::uint64_t>(1000 * outliers) + 7);
  for (std::size_t i = 0; i < drives; ++i) {
    TruncatedDrive drive;
    drive.motion = motion;
    drive.blocks = 64;
    drive.outliers = outliers;
    const TruncatedProblem problem = testing::truncated_problem(drive, random);
    const auto choice = testing::settled_choice(problem.parts, problem.wrong);
    if (!choice) continue;
    const auto begin = std::chrono::steady_clock::now();
    const OutlierProof proof = prove_outliers(problem.parts, *choice);
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    seconds += took;
    longest = std::max(longest, took);
    proven += proof.choice == OutlierChoice::proven ? 1 : 0;
    better += proof.choice == OutlierChoice::not_best ? 1 : 0;
    decided_at_once += proof.choice == OutlierChoice::proven && proof.solves == 0 ? 1 : 0;
  }
  const auto n = static_cast<double>(drives);
  std::printf(
      "%-6s %5.0f %%  proven %5.1f %%  (by leverages alone %5.1f %%, better choice found %4.1f %%)  %.2f ms, "
      "at most %.2f\n",
      name, 100 * outliers, 100 * static_cast<double>(proven) / n,
      100 * static_cast<double>(decided_at_once) / n, 100 * static_cast<double>(better) / n,
      1e3 * seconds / n, 1e3 * longest);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t problems = 10000, drives = 200;
  std::uint64_t seed = 1;
  egocal::cli::Program app("outlier_proof_study", "Proofs of the choice of outliers, right and frequent");
  app.add_option("--problems", problems, "of 16 blocks, against the search through all choices");
  app.add_option("--drives", drives, "of 64 blocks, per line of the table");
  app.add_option("--seed", seed, "of the problems");
  if (const auto code = app.parse(argc, argv)) return *code;

  for (const auto& [motion, name] :
       {std::pair{testing::Motion::dominant_axis, "road"}, {testing::Motion::free, "free"}})
    for (const double outliers : {0.0, 0.05, 0.1, 0.2, 0.3}) proven_part(motion, name, outliers, drives);
  const Tally tally = against_all_choices(problems, seed);
  std::printf(
      "%zu problems of 16 blocks: %zu proven, %zu of them wrongly; %zu refuted, %zu of them wrongly\n",
      tally.problems, tally.proven, tally.wrongly_proven, tally.not_best, tally.wrongly_refuted);
  return tally.wrongly_proven + tally.wrongly_refuted > 0 ? 1 : 0;
}
