// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Streams that are not measured at the same times: how far an extrinsic is off because one of them is
// interpolated: along screws, along screws with both streams cut alike (lib/src/pairing/cut_alike.hpp), and
// smoothly (lib/src/pairing/smooth_interpolation.hpp). A table of docs/method.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/cli/cli.hpp"
#include "markdown_tables.hpp"
#include "support/shaken_car.hpp"
#include "support/simulated_drive.hpp"
#include "uncertainty/frame_a.hpp"

namespace {

using namespace egocal;

struct Case {
  const char* name;
  Terrain terrain;
  double rate_a, rate_b;           ///< [Hz]
  double dropped = 0;              ///< part of the poses of both that are missing
  double lowest = 0, highest = 0;  ///< a road whose car pitches and rolls with these frequencies [Hz]
};

constexpr Case cases[] = {{"free, 4 Hz and 4 Hz", Terrain::free, 4, 4},
                          {"free, 10 Hz and 4 Hz", Terrain::free, 10, 4},
                          {"free, 10 Hz and 7 Hz", Terrain::free, 10, 7},
                          {"free, 10 Hz and 10 Hz", Terrain::free, 10, 10},
                          {"free, 10 Hz and 10 Hz, 30 % lost", Terrain::free, 10, 10, 0.3},
                          {"free, 20 Hz and 20 Hz", Terrain::free, 20, 20},
                          {"road, 10 Hz and 10 Hz", Terrain::rough, 10, 10},
                          {"shaken at 0.5 to 1.5 Hz, 10 Hz and 20 Hz", Terrain::rough, 10, 20, 0, 0.5, 1.5},
                          {"shaken at 1 to 3 Hz, 10 Hz and 10 Hz", Terrain::rough, 10, 10, 0, 1, 3},
                          {"shaken at 1 to 3 Hz, 10 Hz and 20 Hz", Terrain::rough, 10, 20, 0, 1, 3},
                          {"shaken at 2 to 6 Hz, 10 Hz and 20 Hz", Terrain::rough, 10, 20, 0, 2, 6},
                          {"shaken at 2 to 6 Hz, 20 Hz and 20 Hz", Terrain::rough, 20, 20, 0, 2, 6},
                          {"shaken at 2 to 6 Hz, 15 Hz and 8 Hz", Terrain::rough, 15, 8, 0, 2, 6},
                          {"shaken at 4 to 9 Hz, 10 Hz and 10 Hz", Terrain::rough, 10, 10, 0, 4, 9}};

testing::Streams drive(const Case& of, std::uint64_t seed) {
  const double phase = (0.1 + 0.1 * static_cast<double>(seed % 8)) / of.rate_b;
  if (of.highest > 0)
    return testing::shaken_car({.rate_a = of.rate_a,
                                .rate_b = of.rate_b,
                                .phase_b = phase,
                                .lowest = of.lowest,
                                .highest = of.highest,
                                .seconds = 120,
                                .seed = seed});
  SimulationOptions options;
  options.terrain = of.terrain;
  options.seed = seed;
  options.rate = 50;  // of the path
  options.poses = 6'001;
  options.relative_noise = 0.01;
  options.faults.resize(2);
  options.faults[0].rate = of.rate_a;
  options.faults[1].rate = of.rate_b;
  for (SensorFaults& faults : options.faults) faults.dropped = of.dropped;
  options.faults[1].phase = phase;
  return testing::simulated_drive(options);
}

/// Squares [m^2] over directions and drives.
struct Measured {
  double errors = 0, variances = 0;
  int within = 0, of = 0;

  void add(const testing::Streams& streams, const SynchroniserOptions& synchroniser) {
    CalibrationOptions options;
    options.pairing.synchroniser = synchroniser;
    const Calibration found = calibrate(streams.a, streams.b, options);
    const auto error = detail::frame_a_difference(streams.T, to_dual_quaternion(found.T_a_b));
    for (int i = 0; i < 3; ++i) {
      const double stddev = found.observability.stddev[static_cast<std::size_t>(i)];
      if (!std::isfinite(stddev)) continue;
      errors += error[i] * error[i];
      variances += stddev * stddev;
      within += std::abs(error[i]) <= 1.96 * stddev ? 1 : 0;
      ++of;
    }
  }

  std::string centimetres(double squares) const {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f cm", 100 * std::sqrt(3 * squares / std::max(1, of)));
    return text;
  }
};

}  // namespace

int main(int argc, char** argv) {
  std::string write, check;
  std::vector<std::string> only;
  int drives = 12;
  egocal::cli::Program app("interpolation_study",
                           "Streams that are not measured at the same times: a table of docs/method.md");
  app.add_option("--drives", drives, "of each row").check(egocal::cli::Check::range(1, 1000)).show_default();
  app.add_option("--only", only, "rows whose names contain one of these");
  app.add_option("--write", write, "a page: put the table in its place");
  app.add_option("--check", check, "a page: exit 1 where its table differs");
  if (const auto code = app.parse(argc, argv)) return *code;

  SynchroniserOptions screws, cut_alike;
  screws.smooth_poses = cut_alike.smooth_poses = 0;
  screws.cut_alike = false;
  bench::Table table{"interpolation",
                     {{"drive, rates", "error, along screws", "within", "both cut alike", "within", "smooth",
                       "standard deviation", "within"}}};
  for (const Case& of : cases) {
    if (!only.empty() && std::none_of(only.begin(), only.end(), [&](const std::string& part) {
          return std::string(of.name).find(part) != std::string::npos;
        }))
      continue;
    Measured plain, cut, smooth;
    for (int seed = 1; seed <= drives; ++seed) {
      const testing::Streams streams = drive(of, static_cast<std::uint64_t>(seed));
      plain.add(streams, screws);
      cut.add(streams, cut_alike);
      smooth.add(streams, {});
    }
    table.rows.push_back({of.name, plain.centimetres(plain.errors), bench::part(plain.within, plain.of),
                          cut.centimetres(cut.errors), bench::part(cut.within, cut.of),
                          smooth.centimetres(smooth.errors), smooth.centimetres(smooth.variances),
                          bench::part(smooth.within, smooth.of)});
  }
  return bench::publish(table, write, check);
}
