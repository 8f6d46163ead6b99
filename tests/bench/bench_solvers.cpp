// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Every solver on the same problem, beside general solvers, in one run on one thread. Ends with the tables
// of docs/benchmarks.md.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "egocal/baselines/baselines.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/solvers/sdp.hpp"
#include "egocal/solvers/slsqp.hpp"
#include "egocal/solvers/sqp.hpp"
#include "nlopt_rivals.hpp"
#include "silence.hpp"
#include "solver_tables.hpp"
#include "support/random_motion.hpp"
#ifdef EGOCAL_WITH_CSDP
#include "csdp_rival.hpp"
#endif
#ifdef EGOCAL_WITH_SDPA
#include "sdpa_rival.hpp"
#endif

namespace {

using namespace egocal;
using testing::cost_of;
using testing::displacement;
using testing::Motion;
using testing::Random;

/// A drive of 1000 motions with one dominant axis and 1 % noise; warm starts come from its first 990 motions,
/// as a solver that follows a drive has them.
struct Drive {
  DualQuaternion T_a_b;
  std::vector<MotionPair> pairs;
  Matrix8d Q;
  DualQuaternion warm, optimum;

  Drive(Motion motion, std::uint64_t seed, std::uint64_t n = 1000) {
    Random random(seed);
    T_a_b = motion == Motion::planar ? testing::random_planar_extrinsic(random)
                                     : testing::random_extrinsic(random);
    pairs = testing::random_pairs(T_a_b, {.motion = motion, .pairs = n, .noise = 0.01}, random);
    Q = cost_of(pairs);
    optimum = motion == Motion::planar ? solve_planar(Q).q : solve_dual(Q).q;
    const Matrix8d earlier = cost_of({pairs.begin(), pairs.end() - static_cast<std::ptrdiff_t>(n / 100)});
    warm = motion == Motion::planar ? solve_planar(earlier).q : solve_dual(earlier).q;
  }
};

/// Several drives, so that no branch predictor learns one problem.
const std::vector<Drive>& drives(Motion motion) {
  const auto make = [](Motion kind) {
    std::vector<Drive> made;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) made.emplace_back(kind, seed);
    return made;
  };
  static const std::vector<Drive> rough = make(Motion::dominant_axis), planar = make(Motion::planar);
  return motion == Motion::planar ? planar : rough;
}

template <typename Solve>
void run(benchmark::State& state, Motion motion, const Solve& solve) {
  const std::vector<Drive>& all = drives(motion);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solve(all[i]));
    i = (i + 1) % all.size();
  }
}

template <typename Solve>
void add(const char* name, Motion motion, Solve solve) {
  benchmark::RegisterBenchmark(name, [motion, solve](benchmark::State& state) { run(state, motion, solve); });
}

void per_pair(benchmark::State& state) {
  const std::vector<MotionPair>& pairs = drives(Motion::dominant_axis).front().pairs;
  for (auto _ : state) {
    Statistics statistics;
    for (const MotionPair& pair : pairs) statistics.add(pair);
    benchmark::DoNotOptimize(statistics);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs.size()));
}

/// A whole answer: the extrinsic, its certificate and what is known of each direction, by leaving out blocks.
void answer(benchmark::State& state) {
  constexpr std::size_t blocks = 25;  // as pairing keeps of a drive
  std::vector<Problem> problems;
  for (const Drive& drive : drives(Motion::dominant_axis)) {
    Problem& problem = problems.emplace_back();
    problem.blocks.resize(blocks);
    for (std::size_t i = 0; i < drive.pairs.size(); ++i)
      problem.blocks[i * blocks / drive.pairs.size()].add(drive.pairs[i]);
  }
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solve(problems[i], Method::dual));
    i = (i + 1) % problems.size();
  }
}

/// From motions to the answer: how cost grows with their number.
void pairs_to_answer(benchmark::State& state) {
  const Drive drive(Motion::dominant_axis, 1, static_cast<std::uint64_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(solve_dual(cost_of(drive.pairs)));
  state.SetComplexityN(state.range(0));
}

/// Keeps the medians of the processor time.
class Reporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    benchmark::ConsoleReporter::ReportRuns(runs);
    for (const Run& r : runs) {
      if (r.error_occurred) continue;
      if (r.run_type == Run::RT_Aggregate && r.aggregate_name != "median") continue;
      times[r.run_name.function_name] =
          r.GetAdjustedCPUTime() / benchmark::GetTimeUnitMultiplier(r.time_unit);
    }
  }

  bench::Times times;
};

}  // namespace

int main(int argc, char** argv) {
  constexpr Motion rough = Motion::dominant_axis, planar = Motion::planar;
  const DualQuaternion identity;
  add("dual", rough, [](const Drive& d) { return solve_dual(d.Q); });
  add("sqp_warm", rough, [](const Drive& d) { return solve_sqp(d.Q, d.warm); });
  add("sqp_cold", rough, [identity](const Drive& d) { return solve_sqp(d.Q, identity); });
  add("sdp", rough, [](const Drive& d) { return solve_sdp(d.Q); });
  add("slsqp_cold", rough, [identity](const Drive& d) { return solve_slsqp(d.Q, identity); });
  add("slsqp_warm", rough, [](const Drive& d) { return solve_slsqp(d.Q, d.warm); });
  add("planar", planar, [](const Drive& d) { return solve_planar(d.Q); });
  add("verify", rough, [](const Drive& d) { return verify(d.Q, d.optimum); });
  add("verify_planar", planar, [](const Drive& d) { return verify_planar(d.Q, d.optimum); });
#ifdef EGOCAL_WITH_SDPA
  benchmark::RegisterBenchmark("sdpa", [](benchmark::State& state) {
    drives(rough);
    const bench::Silence silence;
    run(state, rough, [](const Drive& d) { return bench::sdpa(d.Q); });
  });
#endif
#ifdef EGOCAL_WITH_CSDP
  benchmark::RegisterBenchmark("csdp", [](benchmark::State& state) {
    drives(rough);
    const bench::Silence silence;
    run(state, rough, [](const Drive& d) { return bench::csdp(d.Q); });
  });
#endif
  add("nlopt_slsqp_cold", rough, [identity](const Drive& d) { return bench::nlopt_slsqp(d.Q, identity); });
  add("nlopt_slsqp_warm", rough, [](const Drive& d) { return bench::nlopt_slsqp(d.Q, d.warm); });
  add("nlopt_auglag_warm", rough,
      [](const Drive& d) { return bench::nlopt_augmented_lagrangian(d.Q, d.warm); });
  add("nlopt_planar_cold", planar, [identity](const Drive& d) { return bench::nlopt_planar(d.Q, identity); });
  add("nlopt_planar_warm", planar, [](const Drive& d) { return bench::nlopt_planar(d.Q, d.warm); });
  benchmark::RegisterBenchmark("answer", answer);
  benchmark::RegisterBenchmark("statistics_add_1000", per_pair);
  add("baseline_analytic", rough, [](const Drive& d) { return solve_analytic(d.pairs); });
  add("baseline_matrix", rough, [](const Drive& d) { return solve_matrix(d.pairs); });
  add("baseline_local", rough, [](const Drive& d) { return solve_local(d.pairs, d.warm); });
  benchmark::RegisterBenchmark("pairs_to_answer", pairs_to_answer)
      ->RangeMultiplier(10)
      ->Range(100, 1'000'000)
      ->Complexity(benchmark::oN);

  benchmark::Initialize(&argc, argv);
  std::string page;
  egocal::cli::Program app(
      "bench_solvers",
      "Times of all solvers: two tables of docs/benchmarks.md. Also takes the options of "
      "Google Benchmark, such as --benchmark_repetitions=5.");
  app.add_option("--write", page, "put the tables into this page");
  if (const auto code = app.parse(argc, argv)) return *code;
  Reporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  std::printf("\n");
  return std::max(bench::publish(bench::solver_times(reporter.times), page, ""),
                  bench::publish(bench::solver_goals(reporter.times), page, ""));
}
