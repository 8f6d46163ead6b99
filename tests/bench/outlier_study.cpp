// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What a fifth of the poses of one stream being grossly wrong costs, for every kind of corruption, in either
// stream, over several draws: the table of docs/accuracy.md.
#include <algorithm>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "egocal/cli/cli.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
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

void print(const char* drive, const Errors& errors) {
  std::printf("%-24s %7.3f   %7.3f %7.3f   %7.3f %7.3f %7.3f  %s\n", drive, quantile(errors.clean, 0.5),
              quantile(errors.missing, 0.5), quantile(errors.missing, 1), quantile(errors.wrong, 0.5),
              quantile(errors.wrong, 0.95), errors.worst, errors.worst_kind.c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t seeds = 6;
  egocal::cli::Program app("outlier_study",
                           "Rotation error [deg] with a fifth of the poses of one stream wrong");
  app.add_option("--draws", seeds, "of what is wrong, per kind and stream")
      .check(egocal::cli::Check::range(1, 1000));
  if (const auto code = app.parse(argc, argv)) return *code;

  std::printf("%-24s %7s   %15s   %23s\n%-24s %7s   %7s %7s   %7s %7s %7s\n", "", "clean", "a fifth missing",
              "a fifth wrong", "", "", "median", "worst", "median", "95 %", "worst");
  for (const auto& [name, terrain] :
       {std::pair{"simulated car", Terrain::rough}, {"simulated, free", Terrain::free}}) {
    Errors errors;
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
      measure(testing::simulated_drive({.terrain = terrain, .relative_noise = 0.01, .seed = seed}), seeds,
              errors);
    print(name, errors);
  }
  if (!testing::have_real_drives()) {
    std::fputs(("the real drives in " + paths::data_dir() + " are not here\n").c_str(), stdout);
    return 0;
  }
  const auto real = [&](const char* name, const Streams& streams) {
    Errors errors;
    measure(streams, seeds, errors);
    print(name, errors);
  };
  real("KITTI 05", testing::kitti("05"));
  real("KITTI 07", testing::kitti("07"));
  real("KITTI 07, A-LOAM", testing::kitti("07", "velodyne_aloam"));
  real("KITTI 05, planar", testing::planar(testing::kitti("05")));
  real("KITTI 07, planar", testing::planar(testing::kitti("07")));
  real("KITTI 0930_27, planar", testing::planar(testing::kitti_asynchronous()));
  real("EuRoC V2_01", testing::euroc());
  real("robot arm", testing::robot_arm());
}
