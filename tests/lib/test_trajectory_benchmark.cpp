// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A third of the public benchmark of Valimaki, Garigipati and Ghabcheloo (Sensors 23(7):3740, 2023), with
// defaults: pairs of trajectories with noise on poses, drift, outliers, and all of them with lasting jumps.
// The bounds are those that maximum likelihood with the noise known comes close to; untuned
// (docs/accuracy.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "../support/paths.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/online/answer.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::test_trajectory_benchmark {
namespace {

namespace fs = std::filesystem;

struct Errors {
  std::vector<double> degrees, centimetres;
  int with_jumps = 0;  ///< runs in which at least five steps were found to be jumps
};

DualQuaternion truth_of(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line) && (line.empty() || line[0] == '#')) continue;
  double x = 0, y = 0, z = 0, qw = 1, qx = 0, qy = 0, qz = 0;
  std::istringstream(line) >> x >> y >> z >> qw >> qx >> qy >> qz;
  return to_dual_quaternion({Eigen::Quaterniond(qw, qx, qy, qz).normalized(), {x, y, z}});
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double worst(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

class TrajectoryBenchmark : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(folder())) GTEST_SKIP() << "no benchmark in " << folder();
  }
  static fs::path folder() { return fs::path(paths::data_dir()) / "tampere"; }

  static Errors errors_of(const std::string& level) {
    std::vector<fs::path> runs;
    for (const auto& entry : fs::directory_iterator(folder() / level)) runs.push_back(entry.path());
    std::sort(runs.begin(), runs.end());
    EXPECT_FALSE(runs.empty()) << level;
    Errors errors;
    for (const fs::path& run : runs) {
      const MotionPairing drive =
          paired({}, read_trajectory((run / "a.tum").string()), read_trajectory((run / "b.tum").string()));
      const Answer answer = solve(drive.problem(), Method::dual);
      EXPECT_EQ(answer.certificate.optimality, Optimality::certified) << run;
      const ExtrinsicError error = extrinsic_error(truth_of(run / "truth.txt"), answer.T_a_b);
      errors.degrees.push_back(error.rotation * 180 / std::numbers::pi);
      errors.centimetres.push_back(100 * error.translation);
      if (drive.counts().jumps >= 5) ++errors.with_jumps;
    }
    return errors;
  }
};

TEST_F(TrajectoryBenchmark, NoiseOnPoses) {
  const Errors low = errors_of("noise/noise_0.002000"), high = errors_of("noise/noise_0.010000");
  EXPECT_LE(median(low.degrees), 0.065);
  EXPECT_LE(median(low.centimetres), 0.14);
  EXPECT_LE(median(high.degrees), 0.28);
  EXPECT_LE(median(high.centimetres), 0.8);
}

TEST_F(TrajectoryBenchmark, Drift) {
  EXPECT_LE(median(errors_of("drift/drift_0.050000").centimetres), 1.2);
}

TEST_F(TrajectoryBenchmark, Outliers) {
  for (const char* level : {"outliers/outliers_4", "outliers/outliers_10"}) {
    const Errors errors = errors_of(level);
    EXPECT_LE(median(errors.degrees), 1e-3) << level;
    EXPECT_LE(worst(errors.degrees), 0.1) << level;
    EXPECT_LE(worst(errors.centimetres), 1) << level;
  }
}

/// Noise, drift and five lasting jumps.
TEST_F(TrajectoryBenchmark, Mixture) {
  const Errors errors = errors_of("mixture");
  EXPECT_LE(median(errors.degrees), 0.42);
  EXPECT_LE(median(errors.centimetres), 1.6);
  EXPECT_GE(errors.with_jumps, 12);
}

}  // namespace
}  // namespace egocal::test_trajectory_benchmark
