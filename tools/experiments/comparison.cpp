// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <utility>

#include "egocal/baselines/baselines.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/degrees.hpp"
#include "egocal/solvers/global.hpp"
#include "egocal/solvers/sdp.hpp"
#include "egocal/solvers/slsqp.hpp"
#include "egocal/solvers/sqp.hpp"
#include "experiments/figure.hpp"

namespace egocal::tools {

namespace {

template <typename Work>
double median_milliseconds(int repeats, const Work& work) {
  std::vector<double> times;
  for (int i = 0; i < std::max(1, repeats); ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  return median(std::move(times));
}

std::string verdict_of(const BaselineAnswer& answer) {
  if (!answer.note.empty()) return answer.note;
  return answer.certified ? "certified" : answer.valid ? "valid" : "not valid";
}

Matrix8d cost_of(const std::vector<MotionPair>& pairs, const Balance& balance) {
  Statistics statistics;
  for (const MotionPair& pair : pairs) statistics.add(pair);
  return cost_matrix(statistics, balance);
}

}  // namespace

std::vector<ComparisonRow> compare(const DataSet& data, int repeats) {
  std::vector<ComparisonRow> rows;
  const auto finish = [&](ComparisonRow row) {
    if (data.truth) row.error = extrinsic_error(*data.truth, row.T_a_b);
    rows.push_back(std::move(row));
  };
  const auto baseline = [&](const char* name, const std::function<BaselineAnswer()>& solve) {
    ComparisonRow row{name, Mode::spatial, {}, {}, 0, ""};
    BaselineAnswer answer;
    row.milliseconds = median_milliseconds(repeats, [&] { answer = solve(); });
    row.T_a_b = answer.T_a_b;
    row.verdict = verdict_of(answer);
    finish(row);
  };
  const auto spatial = [&](const char* name, const std::function<Solution(const Matrix8d&)>& solve) {
    ComparisonRow row{name, Mode::spatial, {}, {}, 0, ""};
    Solution solution;
    row.milliseconds =
        median_milliseconds(repeats, [&] { solution = solve(cost_of(data.pairs, data.balance)); });
    row.T_a_b = solution.q;
    row.verdict = to_string(verify(cost_of(data.pairs, data.balance), solution.q).optimality);
    finish(row);
  };

  const DualQuaternion identity;
  baseline("analytic [19]", [&] { return solve_analytic(data.pairs); });
  baseline("local [7]", [&] { return solve_local(data.pairs, identity); });
  baseline("matrix [8]", [&] { return solve_matrix(data.pairs); });
  spatial("global (sdp)", [](const Matrix8d& Q) { return solve_sdp(Q); });
  spatial("global (dual)", [](const Matrix8d& Q) { return solve_dual(Q); });
  spatial("fast (slsqp)", [&](const Matrix8d& Q) { return solve_slsqp(Q, identity); });
  spatial("fast (sqp)", [&](const Matrix8d& Q) { return solve_sqp(Q, identity); });

  if (data.plane_a && data.plane_b) {
    const DualQuaternion G_a = plane_frame(*data.plane_a), G_b = plane_frame(*data.plane_b);
    const auto planar = [&](const char* name, const std::function<Solution(const Matrix8d&)>& solve) {
      ComparisonRow row{name, Mode::planar, {}, {}, 0, ""};
      Solution solution;
      const auto cost = [&] {
        return cost_of(planar_motions(data.pairs, *data.plane_a, *data.plane_b), data.balance);
      };
      row.milliseconds = median_milliseconds(repeats, [&] { solution = solve(cost()); });
      row.T_a_b = extrinsic_from_planar(solution.q, G_a, G_b);
      row.verdict = to_string(verify_planar(cost(), solution.q).optimality);
      finish(row);
    };
    planar("global (closed form)", [](const Matrix8d& Q) { return solve_planar(Q); });
    planar("fast (slsqp)", [&](const Matrix8d& Q) { return solve_slsqp_planar(Q, identity); });
  }
  return rows;
}

std::string table(const std::vector<ComparisonRow>& rows) {
  std::string text = fmt::format("{:<22} {:<7} {:>12} {:>10} {:>10}  {}\n", "approach", "mode", "e_t [cm]",
                                 "e_r [deg]", "time [ms]", "verdict");
  for (const ComparisonRow& row : rows) {
    const std::string translation = row.error ? fmt::format("{:.2f}", 100 * row.error->translation) : "-";
    const std::string rotation =
        row.error ? fmt::format("{:.3f}", degrees_per_radian * row.error->rotation) : "-";
    text += fmt::format("{:<22} {:<7} {:>12} {:>10} {:>10.4f}  {}\n", row.method,
                        row.mode == Mode::planar ? "planar" : "3-D", translation, rotation, row.milliseconds,
                        row.verdict);
  }
  return text;
}

}  // namespace egocal::tools
