// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "solver_tables.hpp"

#include <fmt/format.h>

#include <iterator>
#include <vector>

namespace egocal::bench {

namespace {

/// Motion pairs of the benchmark statistics_add_1000.
constexpr double pairs_added = 1000;

struct Row {
  const char* benchmark;
  const char* solver;
  const char* note;
  double items = 1;  ///< that one run of the benchmark does
};

constexpr Row rows[] = {
    {"dual", "`solve_dual`", "global, with the proof of its own answer"},
    {"sqp_warm", "`solve_sqp`, warm", "local"},
    {"sqp_cold", "`solve_sqp`, cold", ""},
    {"sdp", "`solve_sdp`", "global; own interior-point method for the LMI (22)"},
    {"slsqp_cold", "`solve_slsqp`, cold", "NLopt's SLSQP in scaled units, with Newton steps at the end"},
    {"slsqp_warm", "`solve_slsqp`, warm", ""},
    {"planar", "`solve_planar`", "global, closed form"},
    {"verify", "`verify`", "the proof of an answer"},
    {"answer", "a whole answer", "extrinsic, certificate, known directions, standard deviations: 25 blocks"},
    {"statistics_add_1000", "`Statistics::add`", "a motion pair", pairs_added},
    {"sdpa", "SDPA, library call", "from building its problem to the multipliers; default tolerance 1e-7"},
    {"csdp", "CSDP, library call", "default parameters"},
    {"nlopt_slsqp_cold", "NLopt SLSQP, cold", "plain calls, constraint tolerance 1e-8, `ftol_rel` 1e-14"},
    {"nlopt_slsqp_warm", "NLopt SLSQP, warm", ""},
    {"nlopt_auglag_warm", "NLopt AUGLAG + truncated Newton, warm",
     "its fastest setting found, `ftol_rel` 1e-8: answers up to 0.9 um off"},
    {"nlopt_planar_cold", "NLopt SLSQP planar (q1, q4, q6, q7), cold", ""},
    {"nlopt_planar_warm", "NLopt SLSQP planar, warm", ""},
    {"baseline_analytic", "`solve_analytic`", "the paper's baseline, from 1000 pairs"},
    {"baseline_matrix", "`solve_matrix`", "the same"},
    {"baseline_local", "`solve_local`", "the same"},
};

std::string duration(double seconds) {
  if (seconds < 1e-6) return fmt::format("{:.3g} ns", seconds * 1e9);
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  return fmt::format("{:.3g} ms", seconds * 1e3);
}

class Goals {
 public:
  explicit Goals(const Times& times) : times_(times) {}

  /// The time of `slow` in those of `fast`.
  void at_least(const char* text, const char* slow, const char* fast, double limit) {
    if (have(slow) && have(fast)) judge(text, times_.at(slow) / times_.at(fast), limit, true);
  }
  void at_most(const char* text, const char* over, const char* under, double limit) {
    if (have(over) && have(under)) judge(text, times_.at(over) / times_.at(under), limit, false);
  }
  /// limit: [s] an item.
  void below(const char* text, const char* name, double limit, double items) {
    if (!have(name)) return;
    const double seconds = times_.at(name) / items;
    add(text, duration(seconds), seconds < limit);
  }

  Table table{"solver-goals", {{"goal", "measured"}}};

 private:
  bool have(const std::string& name) const { return times_.count(name) > 0; }
  void judge(const char* text, double ratio, double limit, bool above) {
    add(text, fmt::format("{:.3g}", ratio), above ? ratio >= limit : ratio <= limit);
  }
  void add(const char* text, const std::string& measured, bool reached) {
    table.rows.push_back({text, measured + (reached ? "" : " (missed)")});
  }

  const Times& times_;
};

}  // namespace

Table solver_times(const Times& times) {
  Table table{"solver-times", {{"solver", "time", ""}}};
  for (const Row& row : rows)
    if (const auto found = times.find(row.benchmark); found != times.end())
      table.rows.push_back({row.solver, duration(found->second / row.items), row.note});
  return table;
}

Table solver_goals(const Times& times) {
  Goals goals(times);
  goals.at_least("dual 100 times as fast as SDPA", "sdpa", "dual", 100);
  goals.at_least("dual 50 times as fast as CSDP", "csdp", "dual", 50);
  goals.at_least("dual 30 times as fast as SLSQP cold", "nlopt_slsqp_cold", "dual", 30);
  goals.at_least("dual faster than SLSQP warm", "nlopt_slsqp_warm", "dual", 1);
  goals.at_least("dual faster than AUGLAG + TNEWTON warm", "nlopt_auglag_warm", "dual", 1);
  goals.at_least("planar 50 times as fast as SLSQP in four variables", "nlopt_planar_cold", "planar", 50);
  goals.at_most("sqp warm over dual, at most 1.5", "sqp_warm", "dual", 1.5);
  goals.below("verification below 3 us", "verify", 3e-6, 1);
  goals.below("a whole answer below 12 us", "answer", 12e-6, 1);
  goals.below("building the cost below 100 ns a pair", "statistics_add_1000", 100e-9, pairs_added);
  return goals.table;
}

}  // namespace egocal::bench
