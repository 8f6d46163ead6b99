// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// How often 1.96 standard deviations cover the truth on short drives of nine machines in ten kinds of noise,
// beside an oracle that is told the form of the noise. The table of docs/intervals.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "egocal/cli/cli.hpp"
#include "egocal/online/answer.hpp"
#include "markdown_tables.hpp"
#include "noise_oracle.hpp"
#include "uncertainty/frame_a.hpp"

namespace {

using namespace egocal;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of one machine, per direction.
struct Tally {
  std::array<int, 6> all{}, covered{};
  std::array<std::vector<double>, 6> errors, stddevs;

  void add(std::size_t k, double error, double stddev) {
    ++all[k];
    covered[k] += std::abs(error) <= 1.96 * stddev;
    errors[k].push_back(std::abs(error));
    stddevs[k].push_back(stddev);
  }
};

struct Row {
  int all = 0, covered = 0;
  double worst = 1;                           ///< covered, of a machine
  double log_ratios = 0, ratios = 0;          ///< of standard deviation to error
  std::array<int, 6> all_of{}, covered_of{};  ///< each direction

  void add(const Tally& machine) {
    int all_here = 0, covered_here = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      all_here += machine.all[k];
      covered_here += machine.covered[k];
      all_of[k] += machine.all[k];
      covered_of[k] += machine.covered[k];
      if (machine.all[k] == 0) continue;
      constexpr double median_error = 0.6745;  // of a normal error of one standard deviation
      log_ratios += std::log(median_error * median(machine.stddevs[k]) / median(machine.errors[k]));
      ratios += 1;
    }
    all += all_here;
    covered += covered_here;
    if (all_here > 0) worst = std::min(worst, static_cast<double>(covered_here) / all_here);
  }
  std::string text() const {
    if (all == 0) return "";
    char line[80];
    std::snprintf(line, sizeof line, "%.1f %%, worst %.1f %%, %.2f", 100.0 * covered / all, 100 * worst,
                  std::exp(log_ratios / ratios));
    return line;
  }
  void print_directions() const {
    constexpr const char* names[] = {"x", "y", "z", "roll", "pitch", "yaw"};
    for (std::size_t k = 0; k < 6; ++k)
      if (all_of[k] > 0) std::fprintf(stderr, " %s %.1f %%", names[k], 100.0 * covered_of[k] / all_of[k]);
    std::fprintf(stderr, "\n");
  }
};

struct Study {
  int drives;
  std::uint64_t first_seed;
  bool with_oracle;
};

void measure(const Study& study, const bench::DriveNoise& noise, int motions, bool plane, Row& ours,
             Row& told) {
  std::uint64_t number = 0;
  for (const bench::Machine& machine : bench::machines) {
    ++number;
    if (plane && !machine.has_ground) continue;
    Tally tally, tally_told;
    for (int drive = 0; drive < study.drives; ++drive) {
      const std::uint64_t seed = 1000003 * number + study.first_seed + static_cast<std::uint64_t>(drive);
      const testing::Streams streams = bench::noisy_drive(machine, noise, motions, plane, seed);
      const Answer answer =
          solve(pair_motions(streams.options, streams.a, streams.b).drive.problem(), Method::dual);
      const auto error = detail::frame_a_difference(streams.T, answer.T_a_b);
      bench::OracleAnswer best;
      if (study.with_oracle) best = bench::oracle(streams, noise, plane);
      for (std::size_t k = 0; k < 6; ++k) {
        const double stddev = answer.observability.stddev[k];
        if (!answer.observability.observable[k] || !std::isfinite(stddev)) continue;
        tally.add(k, error[static_cast<Eigen::Index>(k)], stddev);
        if (best.known[k]) tally_told.add(k, best.error[k], best.stddev[k]);
      }
    }
    ours.add(tally);
    told.add(tally_told);
  }
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program app("machine_study", "coverage of the standard deviations on short drives of nine machines");
  Study study{10, 1, false};
  std::vector<double> sizes{20, 25, 30, 50, 100};
  std::vector<std::string> only;
  bool no_plane = false;
  bool directions = false;
  bool check = false;
  std::string write;
  app.add_option("--drives", study.drives, "of each machine")
      .check(cli::Check::range(1, 100000))
      .show_default();
  app.add_option("--first", study.first_seed, "seed of the first drive").show_default();
  app.add_option("--motions", sizes, "of a drive");
  app.add_option("--only", only, "noises whose names contain one of these words");
  app.add_flag("--oracle", study.with_oracle, "beside an estimator that is told the form of the noise");
  app.add_flag("--no-plane", no_plane, "in three dimensions alone");
  app.add_flag("--directions", directions, "print also how often each one is covered, to standard error");
  app.add_flag("--check", check, "exit 1 where not 92 to 99 % are covered over all rows");
  app.add_option("--write", write, "a page: put the table in its place");
  if (const auto code = app.parse(argc, argv)) return *code;
  bench::Table table{"machines", {{"noise, motions", "three dimensions", "in the plane"}}};
  if (study.with_oracle)
    table = {"machines-oracle",
             {{"noise, motions", "three dimensions", "told the form", "in the plane", "told the form"}}};
  double all = 0, covered = 0;
  for (const bench::DriveNoise& noise : bench::drive_noises) {
    const auto named = [&](const std::string& word) {
      return std::strstr(noise.name, word.c_str()) != nullptr;
    };
    if (!only.empty() && std::none_of(only.begin(), only.end(), named)) continue;
    for (const double motions : sizes) {
      table.rows.push_back({std::string(noise.name) + ", " + std::to_string(static_cast<int>(motions))});
      for (const bool plane : {false, true}) {
        if (plane && no_plane) break;
        Row ours, told;
        measure(study, noise, static_cast<int>(motions), plane, ours, told);
        table.rows.back().push_back(ours.text());
        if (study.with_oracle) table.rows.back().push_back(told.text());
        if (directions) ours.print_directions();
        all += ours.all;
        covered += ours.covered;
      }
      for (const std::string& cell : table.rows.back()) std::fprintf(stderr, "%s | ", cell.c_str());
      std::fprintf(stderr, "\n");
    }
  }
  const int code = bench::publish(table, write, "");
  const bool good = covered >= 0.92 * all && covered <= 0.99 * all;
  return check && !good ? 1 : code;
}
