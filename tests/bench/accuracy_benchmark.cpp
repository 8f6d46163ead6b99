// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Errors on all data sets and on simulated drives, beside equal weights and published numbers: the tables of
// docs/accuracy.md. Run by `scripts/benchmark`.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "egocal/calibrate.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/io/whole_file.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "markdown_tables.hpp"
#include "support/benchmark_runs.hpp"
#include "support/real_drives.hpp"
#include "uncertainty/frame_a.hpp"

namespace {

using namespace egocal;
using bench::Table;
using testing::Streams;

constexpr double degrees = 180 / std::numbers::pi;

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string error_text(double rotation, double translation, const char* length, double unit) {
  return text("%.3f deg, ", rotation * degrees) + text("%.2f ", translation * unit) + length;
}

Calibration calibration_of(const Streams& streams, bool equal_weights) {
  CalibrationOptions options;
  options.pairing = streams.options;
  options.diagnosis.enabled = false;
  if (equal_weights) {
    options.pairing.balance = Balance{};
    options.pairing.robust = false;
    options.pairing.stride = 1;
  }
  return calibrate(streams.a, streams.b, options);
}

DualQuaternion answer_to(const Streams& streams, bool equal_weights) {
  return to_dual_quaternion(calibration_of(streams, equal_weights).T_a_b);
}

ExtrinsicError error_of(const Streams& streams, bool equal_weights) {
  return extrinsic_error(streams.T, answer_to(streams, equal_weights));
}

/// How far three answers are from closing the loop of the three Tango devices.
ExtrinsicError loop_of_tango(bool equal_weights) {
  const auto answer = [&](const char* a, const char* b) {
    Streams streams;
    streams.a = testing::real_trajectory(std::string("eth_tango_easy/") + a + ".tum");
    streams.b = testing::real_trajectory(std::string("eth_tango_easy/") + b + ".tum");
    return answer_to(streams, equal_weights);
  };
  return extrinsic_error(answer("caligula", "nero"), answer("caligula", "mars") * answer("mars", "nero"));
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

struct Medians {
  double rotation, translation, worst_rotation;
};

Medians medians_of(const std::vector<Streams>& drives, bool equal_weights) {
  std::vector<double> rotation, translation;
  for (const Streams& streams : drives) {
    const ExtrinsicError error = error_of(streams, equal_weights);
    rotation.push_back(error.rotation);
    translation.push_back(error.translation);
  }
  return {median(rotation), median(translation), *std::max_element(rotation.begin(), rotation.end())};
}

/// Errors of (32).
Table real_drives() {
  Table table{"real", {{"drive", "equal weights, stride 1", "defaults"}}};
  const auto row = [&](const char* name, const ExtrinsicError& equal, const ExtrinsicError& ours) {
    table.rows.push_back({name, error_text(equal.rotation, equal.translation, "cm", 100),
                          error_text(ours.rotation, ours.translation, "cm", 100)});
  };
  const auto add = [&](const char* name, const Streams& streams) {
    row(name, error_of(streams, true), error_of(streams, false));
  };
  add("KITTI 07, pyLiDAR and ORB-SLAM2, 3-D", testing::kitti("07"));
  add("KITTI 05, the same", testing::kitti("05"));
  add("KITTI 07, A-LOAM", testing::kitti("07", "velodyne_aloam"));
  add("KITTI 05, A-LOAM", testing::kitti("05", "velodyne_aloam"));
  add("KITTI 07, planar", testing::planar(testing::kitti("07")));
  add("KITTI 05, planar", testing::planar(testing::kitti("05")));
  add("KITTI raw 0930_27, asynchronous stamps, planar", testing::planar(testing::kitti_asynchronous()));
  add("KITTI raw 0930_27, asynchronous stamps, 3-D", testing::kitti_asynchronous());
  add("EuRoC V2_01, 200 Hz against 20 Hz", testing::euroc());
  add("robot arm (against the reference estimate)", testing::robot_arm());
  row("Tango, three devices, loop", loop_of_tango(true), loop_of_tango(false));
  return table;
}

/// Every lidar with every camera, in 3-D and in the plane, and the others: where equal weights are more than
/// a tenth better than the defaults.
Table rivals() {
  Table table{"rivals",
              {{"pair", "equal weights, stride 1", "defaults", "off by, equal weights", "off by, defaults",
                "standard deviation"}}};
  int pairs = 0;
  const auto add = [&](const std::string& name, const Streams& streams) {
    ++pairs;
    const Calibration found = calibration_of(streams, false);
    const DualQuaternion equal = answer_to(streams, true), ours = to_dual_quaternion(found.T_a_b);
    const ExtrinsicError theirs = extrinsic_error(streams.T, equal), mine = extrinsic_error(streams.T, ours);
    if (mine.translation <= 1.1 * theirs.translation) return;
    const auto three = [](const auto& x, const auto& y, const auto& z) {
      return text("%.1f", 100 * x) + text(", %.1f", 100 * y) + text(", %.1f cm", 100 * z);
    };
    const auto off = [&](const DualQuaternion& q) {
      const auto d = detail::frame_a_difference(streams.T, q);
      return three(d[0], d[1], d[2]);
    };
    const auto& stddev = found.observability.stddev;
    table.rows.push_back({name, error_text(theirs.rotation, theirs.translation, "cm", 100),
                          error_text(mine.rotation, mine.translation, "cm", 100), off(equal), off(ours),
                          three(stddev[0], stddev[1], stddev[2])});
  };
  const auto both = [&](const std::string& name, const Streams& streams) {
    add(name + ", 3-D", streams);
    add(name + ", planar", testing::planar(streams));
  };
  for (const char* drive : {"05", "07"})
    for (const char* lidar : {"velodyne_pylidar", "velodyne_aloam"})
      for (const char* camera : {"cam0_orbslam2", "cam0_gt"}) {
        Streams streams = testing::kitti(drive, lidar);
        streams.b = testing::real_trajectory(std::string("kitti_") + drive + "/" + camera + ".tum");
        both(std::string("KITTI ") + drive + ", " + lidar + ", " + camera, streams);
      }
  both("KITTI raw 0930_27", testing::kitti_asynchronous());
  add("EuRoC V2_01", testing::euroc());
  add("robot arm", testing::robot_arm());
  table.rows.push_back({"of " + std::to_string(pairs) + " pairs", "", "", "", "", ""});
  return table;
}

struct Level {
  const char *name, *folder, *published;

  std::vector<Streams> runs() const { return testing::benchmark_runs(folder); }
};

const std::vector<Level> levels{{"noise on poses .002", "noise/noise_0.002000", "0.1195 deg, 1.7 mm"},
                                {"noise on poses .010", "noise/noise_0.010000", "0.584 deg, 12.3 mm"},
                                {"drift .05", "drift/drift_0.050000", "9.1 mm"},
                                {"4 outliers", "outliers/outliers_4", "0.287 deg, 10.7 mm"},
                                {"10 outliers", "outliers/outliers_10", "0.287 deg, 10.7 mm"},
                                {"mixture", "mixture", "0.606 deg, 14.6 mm"}};

/// Of 1.96 standard deviations, per direction: in how many runs they cover the truth.
Table coverage() {
  Table table{"coverage", {{"level", "x", "y", "z", "roll", "pitch", "yaw", "all", "sigma / error"}}};
  for (const Level& level : levels) {
    std::array<int, 6> covered{}, seen{};
    double squares = 0, variances = 0;
    for (const Streams& streams : level.runs()) {
      const Calibration found = calibration_of(streams, false);
      const auto error = detail::frame_a_difference(streams.T, to_dual_quaternion(found.T_a_b));
      for (std::size_t i = 0; i < 6; ++i) {
        const double stddev = found.observability.stddev[i], off = error[static_cast<Eigen::Index>(i)];
        if (!found.observability.observable[i] || !std::isfinite(stddev)) continue;
        ++seen[i];
        // truth and poses are written with nine digits
        covered[i] += std::abs(off) <= 1.96 * stddev + 1e-7;
        if (stddev < 1e-6) continue;  // no noise
        squares += off * off / (stddev * stddev);
        variances += 1;
      }
    }
    std::vector<std::string> row{level.name};
    int all_covered = 0, all_seen = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      row.push_back(std::to_string(covered[i]) + " of " + std::to_string(seen[i]));
      all_covered += covered[i];
      all_seen += seen[i];
    }
    row.push_back(text("%.0f %%", 100.0 * all_covered / std::max(1, all_seen)));
    row.push_back(variances > 0 ? text("%.2f", std::sqrt(variances / squares)) : "no noise");
    table.rows.push_back(row);
  }
  return table;
}

/// Medians of 13 runs a level, beside the best of all 36 configurations that were published.
Table tampere() {
  Table table{"tampere", {{"level", "equal weights, stride 1", "defaults", "worst run", "published"}}};
  for (const Level& level : levels) {
    const std::vector<Streams> runs = level.runs();
    const Medians equal = medians_of(runs, true), ours = medians_of(runs, false);
    table.rows.push_back({level.name, error_text(equal.rotation, equal.translation, "mm", 1000),
                          error_text(ours.rotation, ours.translation, "mm", 1000),
                          text("%.3f deg", ours.worst_rotation * degrees), level.published});
  }
  return table;
}

/// Spread of the target; beside it the best of OpenCV's five methods (4.6.0) on the same samples.
Table hand_eye() {
  Table table{"hand-eye", {{"set", "samples", "wrong", "spread of the target", "best of OpenCV's methods"}}};
  for (const auto& [name, published] : {std::pair{"moveit50", "not measured"},
                                        {"fsuarez6", "56 mm"},
                                        {"visp_to-hand", "2.3 mm"},
                                        {"aubo32", "3.7 mm"},
                                        {"scara", "fail"}}) {
    const auto read = [&, set = name](const char* file) {
      return testing::real_trajectory(std::string("hand_eye/") + set + "/" + file);
    };
    const SampleCalibration found =
        calibrate_samples(match_samples(read("hand.tum"), read("eye.tum")).samples);
    table.rows.push_back({name, std::to_string(found.residuals.size()),
                          std::to_string(found.calibration.counts.outliers),
                          text("%.1f mm", 1e3 * found.spread_median), published});
  }
  return table;
}

/// The last columns: Giamou et al. (8), and maximum likelihood with the noise known (test_efficiency).
Table simulated() {
  Table table{
      "simulated",
      {{"drive", "equal weights, stride 1", "defaults", "worst", "matrix [8]", "maximum likelihood"}}};
  const auto add = [&](const char* name, Terrain terrain, int poses, std::uint64_t first, const char* matrix,
                       const char* limit) {
    std::vector<Streams> drives;
    for (std::uint64_t seed = first; seed < first + 20; ++seed) {
      SimulationOptions options;
      options.terrain = terrain;
      options.relative_noise = 0.01;
      options.seed = seed;
      options.poses = poses;
      drives.push_back(testing::simulated_drive(options));
    }
    const Medians equal = medians_of(drives, true), ours = medians_of(drives, false);
    table.rows.push_back({name, text("%.3f deg", equal.rotation * degrees),
                          text("%.3f deg", ours.rotation * degrees),
                          text("%.3f deg", ours.worst_rotation * degrees), matrix, limit});
  };
  add("road, 1000 motions", Terrain::rough, 1001, 1, "0.223 deg", "0.036 deg");
  add("the same, seeds 101 to 120", Terrain::rough, 1001, 101, "", "0.033 deg");
  add("six degrees of freedom, 200 motions", Terrain::free, 201, 1, "0.096 deg", "0.077 deg");
  add("the same, seeds 101 to 120", Terrain::free, 201, 101, "", "0.087 deg");
  return table;
}

struct Part {
  const char* name;
  std::function<Table()> make;
  bool needs_data;
};

}  // namespace

int main(int argc, char** argv) {
  std::string only, check, write;
  double tolerance = 0.03;
  egocal::cli::Program app("accuracy_benchmark", "Errors on all data sets: the tables of docs/accuracy.md");
  app.add_option("--only", only, "one table")
      .check(egocal::cli::Check::one_of({"real", "rivals", "tampere", "coverage", "hand-eye", "simulated"}));
  app.add_option("--check", check, "a page: exit 1 where its tables differ");
  app.add_option("--tolerance", tolerance, "of --check, relative").show_default();
  app.add_option("--write", write, "a page: put the tables in their places");
  if (const auto code = app.parse(argc, argv)) return *code;

  int result = 0;
  bool lacking = false;
  std::string page = write.empty() ? "" : bench::read_page(write);
  const std::string checked = check.empty() ? "" : bench::read_page(check);
  for (const Part& part : {Part{"real", real_drives, true}, Part{"rivals", rivals, true},
                           Part{"tampere", tampere, true}, Part{"coverage", coverage, true},
                           Part{"hand-eye", hand_eye, true}, Part{"simulated", simulated, false}}) {
    if (!only.empty() && only != part.name) continue;
    if (part.needs_data && !testing::have_real_drives()) {
      std::printf("%s: the data in %s are not here\n", part.name, paths::data_dir().c_str());
      lacking = true;
      continue;
    }
    const Table table = part.make();
    std::printf("%s\n%s\n", part.name, bench::markdown(table).c_str());
    std::fflush(stdout);
    if (!write.empty()) page = bench::with_table(page, table);
    if (check.empty()) continue;
    for (const std::string& difference : bench::differences(checked, table, tolerance)) {
      std::printf("%s\n", difference.c_str());
      result = 1;
    }
  }
  if (!write.empty()) write_whole_file(write, page);
  return result == 0 && lacking ? bench::not_compared : result;
}
