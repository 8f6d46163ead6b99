// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>

#include "arguments.hpp"
#include "egocal/baselines/baselines.hpp"
#include "egocal/error.hpp"
#include "egocal/io/pairs_file.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/pairing/congruence.hpp"
#include "egocal/pairing/selection.hpp"
#include "egocal/robust/robust_statistics.hpp"
#include "egocal/solvers/dual.hpp"
#include "egocal/solvers/planar.hpp"
#include "egocal/solvers/sdp.hpp"
#include "egocal/solvers/slsqp.hpp"
#include "egocal/solvers/sqp.hpp"
#include "offline/log_trajectory.hpp"

namespace egocal::tools {

namespace {

StreamSpan span_of(const Trajectory& trajectory) {
  return {trajectory.size(), 1e-6 * static_cast<double>(trajectory.front().time_us),
          1e-6 * static_cast<double>(trajectory.back().time_us)};
}

std::string rejections(const PairingCounts& counts) {
  std::string text;
  for (std::size_t i = 0; i < counts.rejected.size(); ++i)
    if (counts.rejected[i] > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts.rejected[i],
                          name(static_cast<Rejection>(i)));
  return text.empty() ? "none rejected" : "rejected: " + text;
}

/// Motions from trajectories: through a MotionPairing, as online.
std::vector<MotionPair> pair_trajectories(const CalibrationOptions& options, CalibrationResult& result) {
  const MotionSource& source = options.source;
  const Trajectory a = source.log.empty() ? read_trajectory(source.a, source.times_a)
                                          : read_log_trajectory(source.log, source.a);
  const Trajectory b = source.log.empty() ? read_trajectory(source.b, source.times_b)
                                          : read_log_trajectory(source.log, source.b);
  result.a = span_of(a);
  result.b = span_of(b);
  PairingOptions drive_options = options.drive;
  if (options.estimate_time_offset) {
    result.time_offset = estimate_time_offset(a, b);
    if (!result.time_offset)
      throw Error("time offset: cannot be estimated, the streams are too short or never turn");
    drive_options.time_offset = result.time_offset->seconds;
  }
  result.time_offset_applied = drive_options.time_offset;
  PairingResult run = pair_motions(drive_options, a, b);
  result.counts = run.drive.counts();
  result.choice = run.drive.choice();
  result.problem = run.drive.problem();
  if (result.problem.blocks.empty())
    throw Error(
        fmt::format("{}, {}: no motion pairs; a: {} poses from {:.3f} to {:.3f} s, b: {} poses from {:.3f} "
                    "to {:.3f} s; {}",
                    source.a, source.b, result.a->poses, result.a->first, result.a->last, result.b->poses,
                    result.b->first, result.b->last, rejections(result.counts)));
  if (options.drive.stride) return run.pairs;
  // the stride was chosen on the way: the pairs of that stride from the beginning
  drive_options.stride = result.choice.stride;
  drive_options.balance = result.choice.balance;
  return pair_motions(drive_options, a, b).pairs;
}

/// Motions from a file of pairs.
std::vector<MotionPair> read_pairs(const CalibrationOptions& options, CalibrationResult& result) {
  std::vector<MotionPair> pairs = egocal::read_pairs(options.source.pairs);
  if (options.drive.robust) {
    const std::vector<bool> wrong = incongruent(pairs);
    std::size_t i = 0;
    result.counts.rejected[static_cast<std::size_t>(Rejection::screw_congruence)] =
        std::erase_if(pairs, [&](const MotionPair&) { return wrong[i++]; });
  }
  result.problem.mode = options.drive.mode;
  result.problem.plane_a = options.drive.plane_a;
  result.problem.plane_b = options.drive.plane_b;
  result.problem.prior = options.drive.prior;
  if (options.drive.mode == Mode::planar) {
    const DualQuaternion G_a = plane_frame(options.drive.plane_a), G_b = plane_frame(options.drive.plane_b);
    for (MotionPair& pair : pairs) {
      pair.a = planar_motion(pair.a, G_a);
      pair.b = planar_motion(pair.b, G_b);
    }
  }
  result.problem.balance = options.drive.balance.value_or(Balance{});
  RobustStatistics statistics;
  for (const MotionPair& pair : pairs) {
    if (!options.drive.robust) {
      statistics.add_unjudged(pair);
      continue;
    }
    statistics.add(pair, result.problem);
    if (statistics.look_is_due()) statistics.look(result.problem);
  }
  if (options.drive.robust) statistics.look(result.problem);
  result.problem.blocks = statistics.inliers();
  result.counts.matched = statistics.inlier_pairs();
  result.counts.outliers = statistics.outlier_pairs();
  result.choice.balance = options.drive.balance.value_or(Balance{});
  result.choice.reason = "fixed";
  if (!options.drive.balance) {
    std::vector<Candidate> candidates;
    for (const double translation : {1.0, 0.1, 0.01, 0.001})
      candidates.push_back({1, {1, translation}, result.problem.blocks});
    result.choice.reason = "too few motions to choose";
    if (const auto selection = select(result.problem, candidates, std::nullopt)) {
      result.choice.balance = candidates[selection->index].balance;
      result.choice.reason = "smallest jack-knife spread of 4 balances";
    }
  }
  result.problem.balance = result.choice.balance;
  return pairs;
}

/// Median time of one call, of as many as fit into a tenth of a second, at least five [us].
double median_us(const std::function<void()>& call) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  const auto begin = Clock::now();
  while (times.size() < 5 || (times.size() < 1001 && Clock::now() - begin < std::chrono::milliseconds(100))) {
    const auto start = Clock::now();
    call();
    times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  return times[times.size() / 2];
}

void solve_with_baseline(const CalibrationOptions& options, const std::vector<MotionPair>& pairs,
                         CalibrationResult& result) {
  if (options.drive.mode == Mode::planar)
    throw UsageError("--method " + options.method + ": has no planar mode");
  const auto run = [&] {
    if (options.method == "analytic") return solve_analytic(pairs);
    if (options.method == "matrix") return solve_matrix(pairs);
    return solve_local(pairs);
  };
  const BaselineAnswer baseline = run();
  result.answer.T_a_b = canonical_sign(normalized(baseline.T_a_b));
  // these methods minimise other things: what their answer is worth is what our certificate says of it
  const Matrix8d Q = cost_matrix(result.problem);
  result.answer.certificate = verify(Q, result.answer.T_a_b);
  result.answer.observability = solve(result.problem, Method::dual).observability;
  result.note = baseline.valid ? "" : baseline.note;
  result.solve_us = median_us([&] { run(); });
}

void solve_with_method(Method method, CalibrationResult& result) {
  const bool planar = result.problem.mode == Mode::planar;
  result.answer = solve(result.problem, method);
  const Matrix8d Q = cost_matrix(result.problem);
  if (planar && method != Method::slsqp) result.method = "planar";
  volatile double keep = 0;
  result.solve_us = median_us([&] {
    if (planar)
      keep = method == Method::slsqp ? solve_slsqp_planar(Q, {}).cost : solve_planar(Q).cost;
    else if (method == Method::dual)
      keep = solve_dual(Q).cost;
    else if (method == Method::sdp)
      keep = solve_sdp(Q).cost;
    else if (method == Method::sqp)
      keep = solve_sqp(Q, {}).cost;
    else
      keep = solve_slsqp(Q, {}).cost;
  });
  (void)keep;
}

}  // namespace

CalibrationResult calibrate_offline(const CalibrationOptions& options) {
  CalibrationResult result;
  const std::vector<MotionPair> pairs =
      options.source.pairs.empty() ? pair_trajectories(options, result) : read_pairs(options, result);
  const std::optional<Method> method = method_from_name(options.method);
  result.method = method ? std::string(name(*method)) : options.method;
  if (method)
    solve_with_method(*method, result);
  else
    solve_with_baseline(options, pairs, result);
  return result;
}

}  // namespace egocal::tools
