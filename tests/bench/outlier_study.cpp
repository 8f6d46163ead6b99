// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What a fifth of the poses of one stream being grossly wrong costs, for every kind of corruption, in either
// stream, over several draws: the table of docs/accuracy.md.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

#include "egocal/cli/cli.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "markdown_tables.hpp"
#include "support/corruption.hpp"
#include "support/paths.hpp"
#include "support/real_drives.hpp"

namespace {

using namespace egocal;
using testing::Corruption;
using testing::Streams;

double degrees_off(const Streams& streams, const Trajectory& a, const Trajectory& b) {
  const Answer answer = solve(pair_motions(streams.options, a, b).drive.problem(), Method::dual);
  return extrinsic_error(streams.T, answer.T_a_b).rotation * 180 / std::numbers::pi;
}

struct Errors {
  std::vector<double> clean, missing, wrong;  ///< [deg]
  double worst = 0;
  std::string worst_kind;
};

void measure(const Streams& streams, std::uint64_t seeds, Errors& errors) {
  errors.clean.push_back(degrees_off(streams, streams.a, streams.b));
  for (std::uint64_t seed = 1; seed <= seeds; ++seed)
    for (const Corruption corruption : testing::corruptions)
      for (const bool in_b : {false, true}) {
        const double error =
            in_b ? degrees_off(streams, streams.a, testing::corrupted(streams.b, corruption, seed))
                 : degrees_off(streams, testing::corrupted(streams.a, corruption, seed), streams.b);
        (corruption == Corruption::missing ? errors.missing : errors.wrong).push_back(error);
        if (corruption == Corruption::missing || error <= errors.worst) continue;
        errors.worst = error;
        errors.worst_kind = testing::to_string(corruption) + (in_b ? " in b" : " in a");
      }
}

double quantile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(part * static_cast<double>(values.size())))];
}

std::string numbers(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, value < 1 ? "%.3f" : "%.2f", value);
    text += (text.empty() ? "" : ", ") + std::string(buffer);
  }
  return text;
}

struct Drive {
  const char* name;
  std::function<std::vector<Streams>()> streams;
  bool needs_data;
};

std::vector<Streams> simulated(Terrain terrain) {
  std::vector<Streams> drives;
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    drives.push_back(testing::simulated_drive({.terrain = terrain, .relative_noise = 0.01, .seed = seed}));
  return drives;
}

std::vector<Drive> all_drives() {
  const auto one = [](auto make) { return [make] { return std::vector<Streams>{make()}; }; };
  return {
      {"simulated car", [] { return simulated(Terrain::rough); }, false},
      {"simulated, free", [] { return simulated(Terrain::free); }, false},
      {"KITTI 05, 3-D", one([] { return testing::kitti("05"); }), true},
      {"KITTI 07, 3-D", one([] { return testing::kitti("07"); }), true},
      {"KITTI 07, A-LOAM", one([] { return testing::kitti("07", "velodyne_aloam"); }), true},
      {"KITTI 05, planar", one([] { return testing::planar(testing::kitti("05")); }), true},
      {"KITTI 07, planar", one([] { return testing::planar(testing::kitti("07")); }), true},
      {"KITTI raw 0930_27, planar", one([] { return testing::planar(testing::kitti_asynchronous()); }), true},
      {"EuRoC V2_01", one([] { return testing::euroc(); }), true},
      {"robot arm", one([] { return testing::robot_arm(); }), true},
  };
}

std::vector<std::string> row(const Drive& drive, std::uint64_t seeds) {
  Errors errors;
  for (const Streams& streams : drive.streams()) measure(streams, seeds, errors);
  return {drive.name, numbers({quantile(errors.clean, 0.5)}),
          numbers({quantile(errors.missing, 0.5), quantile(errors.missing, 1)}),
          numbers({quantile(errors.wrong, 0.5), quantile(errors.wrong, 0.95), errors.worst}),
          errors.worst_kind};
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t seeds = 6;
  std::string only, write, check;
  egocal::cli::Program app("outlier_study",
                           "Rotation error [deg] with a fifth of the poses of one stream wrong: a table of "
                           "docs/accuracy.md");
  app.add_option("--draws", seeds, "of what is wrong, per kind and stream")
      .check(egocal::cli::Check::range(1, 1000));
  app.add_option("--only", only, "the drives whose names contain this");
  app.add_option("--write", write, "a page: put the table in its place");
  app.add_option("--check", check, "a page: exit 1 where its rows for these drives differ");
  if (const auto code = app.parse(argc, argv)) return *code;

  bench::Table table{
      "outliers",
      {{"drive", "clean", "missing: median, worst", "with outliers: median, 95 %, worst", "the worst"}}};
  for (const Drive& drive : all_drives()) {
    if (std::string(drive.name).find(only) == std::string::npos) continue;
    if (drive.needs_data && !testing::have_real_drives()) {
      std::printf("%s: the data in %s are not here\n", drive.name, paths::data_dir().c_str());
      continue;
    }
    table.rows.push_back(row(drive, seeds));
  }
  return bench::publish(table, write, check);
}
