// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Mistakes that users make, on real and on simulated drives: what the verdict is, and whether a finding names
// the cause. The table of docs/trust.md. Fails where an answer that is off by more than a degree or 60 cm is
// called good without a finding that names the cause, or a clean drive doubtful.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/error.hpp"
#include "egocal/evaluation/errors.hpp"
#include "support/mistakes.hpp"
#include "support/paths.hpp"
#include "support/real_drives.hpp"

namespace {

using namespace egocal;
using testing::Mistake;
using testing::Streams;

struct Drive {
  std::string name;
  Streams streams;
  bool truth = true;
};

struct Totals {
  int runs = 0, off = 0, silent = 0, traced = 0, named = 0;
  int clean = 0, alarms = 0;
  double seconds = 0;
};

Streams of_files(const std::string& folder, const char* a, const char* b) {
  return {{}, testing::real_trajectory(folder + a), testing::real_trajectory(folder + b), {}};
}

/// Every fourth run of each level, with the truth of the benchmark.
void add_tampere(std::vector<Drive>& drives) {
  const std::filesystem::path root = paths::data_dir() + "/tampere";
  std::vector<std::filesystem::path> truths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
    if (entry.path().filename() == "truth.txt") truths.push_back(entry.path());
  std::sort(truths.begin(), truths.end());
  for (std::size_t i = 0; i < truths.size(); i += 4) {
    const std::string folder =
        std::filesystem::relative(truths[i].parent_path(), paths::data_dir()).string() + "/";
    Streams streams = of_files(folder, "a.tum", "b.tum");
    std::ifstream file(truths[i]);
    Pose T;
    double w = 1, x = 0, y = 0, z = 0;
    std::string comment;
    while ((file >> std::ws).peek() == '#') std::getline(file, comment);
    file >> T.translation[0] >> T.translation[1] >> T.translation[2] >> w >> x >> y >> z;
    T.rotation = Eigen::Quaterniond(w, x, y, z).normalized();
    streams.T = to_dual_quaternion(T);
    drives.push_back({folder, std::move(streams), static_cast<bool>(file)});
  }
}

std::vector<Drive> real_drives(bool small) {
  std::vector<Drive> drives;
  if (!testing::have_real_drives()) return drives;
  drives.push_back({"KITTI 07", testing::kitti("07")});
  drives.push_back({"EuRoC", testing::euroc()});
  if (small) return drives;
  drives.push_back({"KITTI 05", testing::kitti("05")});
  drives.push_back({"KITTI 05 a-loam", testing::kitti("05", "velodyne_aloam")});
  drives.push_back({"KITTI 07 a-loam", testing::kitti("07", "velodyne_aloam")});
  drives.push_back({"KITTI 0930", testing::kitti_asynchronous()});
  drives.push_back({"arm", testing::robot_arm()});
  const std::string tango = "eth_tango_easy/";
  drives.push_back({"tango c-m", of_files(tango, "caligula.tum", "mars.tum"), false});
  drives.push_back({"tango c-n", of_files(tango, "caligula.tum", "nero.tum"), false});
  drives.push_back({"tango m-n", of_files(tango, "mars.tum", "nero.tum"), false});
  add_tampere(drives);
  for (const char* name : {"fsuarez6", "moveit50", "aubo32", "scara", "visp_to-hand"})
    drives.push_back({name, of_files(std::string("hand_eye/") + name + "/", "hand.tum", "eye.tum"), false});
  return drives;
}

enum class Noise { white, wandering, heavy_tailed, outliers };

std::vector<Drive> simulated_drives(int seeds, int poses) {
  std::vector<Drive> drives;
  constexpr const char* terrains[] = {"flat", "rough", "free"};
  constexpr const char* noises[] = {"white", "wandering", "heavy-tailed", "outliers"};
  for (int seed = 1; seed <= seeds; ++seed)
    for (const Terrain terrain : {Terrain::flat, Terrain::rough, Terrain::free})
      for (const double level : {0.001, 0.01, 0.1})
        for (const Noise noise : {Noise::white, Noise::wandering, Noise::heavy_tailed, Noise::outliers}) {
          SimulationOptions options;
          options.terrain = terrain;
          options.relative_noise = level;
          options.random_walk = noise == Noise::wandering;
          options.heavy_tails = noise == Noise::heavy_tailed;
          options.poses = poses;
          options.seed = static_cast<std::uint64_t>(seed);
          if (noise == Noise::outliers) {
            options.faults.resize(2);
            options.faults[1].outliers = 0.05;
          }
          char name[64];
          std::snprintf(name, sizeof name, "%s %g %% %s, %d", terrains[static_cast<int>(terrain)],
                        100 * level, noises[static_cast<int>(noise)], seed);
          drives.push_back({name, testing::simulated_drive(options)});
        }
  return drives;
}

void run(const Drive& drive, const Mistake& mistake, Totals& totals, bool verbose) {
  Streams streams = drive.streams;
  mistake.make(streams);
  CalibrationOptions options;
  options.pairing = streams.options;
  Calibration calibration;
  const auto begin = std::chrono::steady_clock::now();
  try {
    calibration = calibrate(streams.a, streams.b, options);
  } catch (const Error& error) {
    if (verbose)
      std::printf("%-24s %-24s refused: %s\n", drive.name.c_str(), mistake.name.c_str(), error.what());
    return;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  totals.seconds += seconds;
  ++totals.runs;
  ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(calibration.T_a_b));
  const bool off = drive.truth && (error.rotation > std::numbers::pi / 180 || error.translation > 0.6);
  const bool alarm = calibration.verdict >= Verdict::doubtful;
  bool named = false;
  std::string codes;
  for (const Finding& finding : calibration.findings) {
    named = named || finding.code == mistake.code;
    codes += " " + finding.code + (finding.certain ? "!" : "?");
  }
  const bool clean = mistake.name == "none";
  bool bad = false;
  if (off) ++totals.off;
  if (off && calibration.verdict == Verdict::good && (!named || clean)) {
    ++totals.silent;
    bad = true;
  }
  if (clean) {
    ++totals.clean;
    if (alarm) ++totals.alarms;
    bad = bad || alarm;
  } else if (off && !mistake.code.empty()) {
    ++totals.traced;
    if (named) ++totals.named;
  }
  if (verbose || bad)
    std::printf("%-24s %-24s %-14s off %8.2f deg %9.1f cm  fit %6.2f %%  %4.0f ms %s%s%s\n",
                drive.name.c_str(), mistake.name.c_str(), std::string(to_string(calibration.verdict)).c_str(),
                drive.truth ? error.rotation * 180 / std::numbers::pi : 0.0,
                drive.truth ? 100 * error.translation : 0.0,
                100 * calibration.fit.translation_relative_median, 1e3 * seconds, codes.c_str(),
                !clean && !mistake.code.empty() && !named ? "  NOT NAMED" : "", bad ? "  BAD" : "");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program program("mistake_study", "verdicts on mistakes that users make", "");
  int seeds = 1, poses = 1001;
  bool small = false, clean = false, verbose = false;
  std::string only;
  program.add_option("--seeds", seeds, "of the simulated drives; 0: none");
  program.add_option("--poses", poses, "of the simulated drives");
  program.add_option("--mistake", only, "this one alone");
  program.add_flag("--small", small, "two real drives");
  program.add_flag("--clean", clean, "without mistakes");
  program.add_flag("--verbose", verbose, "every run");
  program.callback([&] {
    std::vector<Drive> drives = simulated_drives(seeds, poses);
    for (Drive& drive : real_drives(small)) drives.push_back(std::move(drive));
    Totals totals;
    for (const Mistake& mistake : testing::mistakes()) {
      if (clean && mistake.name != "none") continue;
      if (!only.empty() && mistake.name != only) continue;
      for (const Drive& drive : drives) run(drive, mistake, totals, verbose);
    }
    std::printf(
        "%d runs, %.0f ms each; %d answers off by more than a degree or 60 cm, %d of them called good "
        "without the cause;\n%d of %d causes of those named; %d clean drives, %d false alarms\n",
        totals.runs, 1e3 * totals.seconds / std::max(1, totals.runs), totals.off, totals.silent, totals.named,
        totals.traced, totals.clean, totals.alarms);
    if (totals.silent > 0 || 100 * totals.alarms > totals.clean) throw cli::Exit{1};
  });
  return program.run(argc, argv);
}
