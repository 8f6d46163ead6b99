// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Mistakes that users make, on real and on simulated drives: what the verdict is, and whether a finding names
// the cause. The tables of docs/trust_measured.md. Fails where an answer that is off by more than a degree or
// 60 cm is called good without a finding that names the cause, where fewer than 90 % of the causes are named,
// or where more than 1 % of the clean drives are doubtful.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/error.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/io/whole_file.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "markdown_tables.hpp"
#include "study_drives.hpp"
#include "support/mistakes.hpp"
#include "support/mistakes_of_samples.hpp"
#include "uncertainty/frame_a.hpp"

namespace {

using namespace egocal;
using bench::StudyDrive;
using bench::Table;
using testing::Mistake;

struct Totals {
  int runs = 0, off = 0, silent = 0, traced = 0, named = 0, refused = 0;
  int clean = 0, alarms = 0;
  std::array<int, 4> verdicts{};
  double seconds = 0;

  void add(const Totals& other) {
    runs += other.runs, off += other.off, silent += other.silent, traced += other.traced;
    named += other.named, refused += other.refused, clean += other.clean, alarms += other.alarms;
    for (std::size_t i = 0; i < verdicts.size(); ++i) verdicts[i] += other.verdicts[i];
    seconds += other.seconds;
  }
};

/// Off by more than a degree or 60 cm in rotation or in translation, where the answer calls all of it
/// observable: a height that flat ground does not show, and what of it leaks into x and y, is no trace of a
/// mistake.
bool off_where_observable(const DualQuaternion& T, const Calibration& calibration) {
  const detail::Vector6d error = detail::frame_a_difference(T, to_dual_quaternion(calibration.T_a_b));
  const auto& o = calibration.observability.observable;
  return (o[0] && o[1] && o[2] && error.head<3>().norm() > 0.6) ||
         (o[3] && o[4] && o[5] && error.tail<3>().norm() > std::numbers::pi / 180);
}

void run(const StudyDrive& drive, const Mistake& mistake, Totals& totals, bool verbose) {
  testing::Streams streams = drive.streams;
  mistake.make(streams);
  CalibrationOptions options;
  options.pairing = streams.options;
  Calibration calibration;
  const auto begin = std::chrono::steady_clock::now();
  ++totals.runs;
  try {
    calibration = calibrate(streams.a, streams.b, options);
  } catch (const Error& error) {
    ++totals.refused;
    if (verbose)
      std::printf("%-24s %-24s refused: %s\n", drive.name.c_str(), mistake.name.c_str(), error.what());
    return;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  totals.seconds += seconds;
  ++totals.verdicts[static_cast<std::size_t>(calibration.verdict)];
  const ExtrinsicError error = extrinsic_error(streams.T, to_dual_quaternion(calibration.T_a_b));
  const bool off = drive.truth && (error.rotation > std::numbers::pi / 180 || error.translation > 0.6);
  const bool traced = off && off_where_observable(streams.T, calibration);
  bool named = false;
  std::string codes;
  for (const Finding& finding : calibration.findings) {
    named = named || finding.code == mistake.code;
    codes += " " + finding.code + (finding.certain ? "!" : "?");
  }
  const bool clean = mistake.name == "none";
  // still poses given as a stream are a mistake of their own
  const bool samples = codes.find(" samples") != std::string::npos && drive.kind.starts_with("sets");
  bool bad = false;
  if (off) ++totals.off;
  if (off && calibration.verdict == Verdict::good && (!named || clean)) {
    ++totals.silent;
    bad = true;
  }
  if (clean) {
    const bool alarm = calibration.verdict >= Verdict::doubtful && !samples;
    ++totals.clean;
    if (alarm) ++totals.alarms;
    bad = bad || alarm;
  } else if (traced && !mistake.code.empty()) {
    ++totals.traced;
    if (named) ++totals.named;
  }
  const bool missed = traced && !clean && !mistake.code.empty() && !named;
  if (verbose || bad || missed)
    std::printf("%-30s %-24s %-14s off %8.2f deg %9.1f cm  fit %6.2f %%  %4.0f ms %s%s%s\n",
                drive.name.c_str(), mistake.name.c_str(), std::string(to_string(calibration.verdict)).c_str(),
                drive.truth ? error.rotation * 180 / std::numbers::pi : 0.0,
                drive.truth ? 100 * error.translation : 0.0,
                100 * calibration.fit.translation_relative_median, 1e3 * seconds, codes.c_str(),
                missed ? "  NOT NAMED" : "", bad ? "  BAD" : "");
  if (bad && drive.truth) {
    const detail::Vector6d x = detail::frame_a_difference(streams.T, to_dual_quaternion(calibration.T_a_b));
    for (int i = 0; i < 6; ++i)
      std::printf(" %.3g +- %.2g", x[i], calibration.observability.stddev[static_cast<std::size_t>(i)]);
    std::printf("  %s\n", calibration.reason.c_str());
  }
  std::fflush(stdout);
}

std::string count(int n) {
  return std::to_string(n);
}

/// Simulated drives of one mistake: all, or a few of them, of every terrain, level and kind of noise by
/// turns.
std::vector<const StudyDrive*> chosen(const std::vector<StudyDrive>& drives, std::size_t mistake,
                                      std::size_t few) {
  std::vector<const StudyDrive*> result;
  const std::size_t n = drives.size();
  // a third of the drives further on and a level and a kind of noise: see simulated_study_drives()
  for (std::size_t k = 0; k < (few > 0 ? std::min(few, n) : n); ++k)
    result.push_back(&drives[few > 0 ? (7 * mistake + 17 * k) % n : k]);
  return result;
}

struct Study {
  std::vector<StudyDrive> simulated, real;
  std::vector<StudyDrive> of_speeds;  ///< as simulated, at speeds that vary
  std::string only, from;             ///< this mistake alone; this one and those after it; empty: all
  double rate_b = 0;                  ///< see simulated_study_drive()
  std::size_t few = 0;                ///< simulated drives of each mistake, and one real one; 0: all
  bool verbose = false;
};

Table mistakes(const Study& study, Totals& totals) {
  Table table{
      "mistakes",
      {{"mistake", "answers", "off by more than 1 deg or 60 cm", "of these where observable: cause named",
        "good", "incomplete", "doubtful", "contradictory"}}};
  const std::vector<Mistake> all = testing::mistakes();
  bool begun = study.from.empty();
  for (std::size_t m = 0; m < all.size(); ++m) {
    const Mistake& mistake = all[m];
    begun = begun || mistake.name == study.from;
    if (!begun || mistake.name == "none" || (!study.only.empty() && mistake.name != study.only)) continue;
    Totals row;
    for (const StudyDrive* drive :
         chosen(mistake.of_speeds ? study.of_speeds : study.simulated, m, study.few))
      run(*drive, mistake, row, study.verbose);
    for (std::size_t i = 0; i < study.real.size(); ++i)
      if (study.few == 0 || i == m % study.real.size()) run(study.real[i], mistake, row, study.verbose);
    const std::string named = mistake.code.empty() ? "" : count(row.named) + " of " + count(row.traced);
    table.rows.push_back({mistake.name, count(row.runs - row.refused), count(row.off), named});
    for (const int n : row.verdicts) table.rows.back().push_back(count(n));
    totals.add(row);
  }
  return table;
}

/// The drives of the series from first on, as many as series states, besides the drives of the study.
Table clean(const Study& study, std::size_t first, std::size_t series, int poses, Totals& totals) {
  Table table{"clean", {{"drives", "number", "good", "incomplete", "doubtful", "contradictory"}}};
  std::map<std::string, Totals> rows;
  const Mistake none = testing::mistakes().front();
  const auto take = [&](const StudyDrive& drive) { run(drive, none, rows[drive.kind], study.verbose); };
  for (const StudyDrive& drive : study.simulated) take(drive);
  for (std::size_t i = first; i < first + series; ++i) take(bench::drive_of_series(i, poses, study.rate_b));
  for (const StudyDrive& drive : study.real) take(drive);
  for (const auto& [kind, row] : rows) {
    table.rows.push_back({kind, count(row.runs)});
    for (const int n : row.verdicts) table.rows.back().push_back(count(n));
    totals.add(row);
  }
  return table;
}

/// Sets of still poses: a camera on the hand of an arm, noise of 0.2 degrees and 2 mm.
Table samples(int sets, Totals& totals) {
  constexpr std::size_t size = 20;
  constexpr double off_by = 0.02;  // an arm wants less than a vehicle [m]
  Table table{"samples",
              {{"mistake", "sets", "off by more than 1 deg or 2 cm", "of these: cause named", "good",
                "incomplete", "doubtful", "contradictory"}}};
  for (const testing::SampleMistake& mistake : testing::mistakes_of_samples()) {
    Totals row;
    for (int seed = 1; seed <= sets; ++seed) {
      testing::Random random(static_cast<std::uint64_t>(seed));
      testing::ArmSamples what;
      what.samples = size;
      what.rotation_noise = 0.2;
      what.position_noise = 2;
      testing::SimulatedSamples drawn = testing::simulate_arm(what, random);
      mistake.make(drawn.samples);
      const Calibration found = calibrate_samples(drawn.samples).calibration;
      const ExtrinsicError error = extrinsic_error(drawn.X, to_dual_quaternion(found.T_a_b));
      const bool off = error.rotation > std::numbers::pi / 180 || error.translation > off_by;
      const bool named = std::any_of(found.findings.begin(), found.findings.end(),
                                     [&](const Finding& one) { return one.code == mistake.code; });
      ++row.runs;
      ++row.verdicts[static_cast<std::size_t>(found.verdict)];
      row.off += off;
      row.silent += off && found.verdict == Verdict::good && !named;
      row.traced += off && !mistake.code.empty();
      row.named += off && named;
      if (mistake.name == "none") ++row.clean, row.alarms += found.verdict >= Verdict::doubtful;
    }
    table.rows.push_back({mistake.name, count(row.runs), count(row.off),
                          mistake.code.empty() ? "" : count(row.named) + " of " + count(row.traced)});
    for (const int n : row.verdicts) table.rows.back().push_back(count(n));
    totals.add(row);
  }
  return table;
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program program("mistake_study", "verdicts on mistakes that users make, and on clean drives", "");
  Study study;
  int seeds = 1, poses = 1001, first = 0, series = 0, few = 0, sets = 0;
  bool no_real = false;
  bool few_real = false, only_clean = false;
  std::string write, check;
  program.add_option("--seeds", seeds, "of the simulated drives; 0: none");
  program.add_option("--poses", poses, "of the simulated drives");
  program.add_option("--rate-b", study.rate_b, "own rate of b [Hz], stamps of its own; 0: a's stamps");
  std::vector<std::string> names;
  for (const Mistake& mistake : testing::mistakes()) names.push_back(mistake.name);
  program.add_option("--mistake", study.only, "this one alone").check(cli::Check::one_of(names));
  program.add_option("--from", study.from, "this one and those after it").check(cli::Check::one_of(names));
  program.add_option("--few", few, "simulated drives and one real one for each mistake; 0: all");
  program.add_option("--series", series, "clean simulated drives besides");
  program.add_option("--first", first, "number of the series' first drive, to run it in parts");
  program.add_option("--sets", sets, "of still poses with each mistake that is made with them; 0: none");
  program.add_option("--write", write, "a page: put the tables in their places");
  program.add_option("--check", check, "a page: exit 1 where its tables differ");
  program.add_flag("--small", few_real, "two real drives");
  program.add_flag("--simulated", no_real, "no real drives");
  program.add_flag("--clean", only_clean, "without mistakes");
  program.add_flag("--verbose", study.verbose, "every run");
  program.callback([&] {
    study.simulated = bench::simulated_study_drives(seeds, poses, study.rate_b);
    study.of_speeds = bench::study_drives_of_speeds(seeds, poses, study.rate_b);
    if (!no_real) study.real = bench::real_study_drives(few_real);
    study.few = static_cast<std::size_t>(std::max(0, few));
    Totals totals;
    std::vector<Table> tables;
    if (study.only.empty() && study.from.empty())
      tables.push_back(clean(study, static_cast<std::size_t>(std::max(0, first)),
                             static_cast<std::size_t>(std::max(0, series)), poses, totals));
    if (!only_clean && (seeds > 0 || !no_real)) tables.push_back(mistakes(study, totals));
    if (sets > 0) tables.push_back(samples(sets, totals));
    std::string page = write.empty() ? "" : bench::read_page(write);
    bool same = true;
    for (const Table& table : tables) {
      std::printf("%s\n%s\n", table.name.c_str(), bench::markdown(table).c_str());
      if (!write.empty()) page = bench::with_table(page, table);
      if (check.empty()) continue;
      for (const std::string& difference : bench::differences(bench::read_page(check), table, 0)) {
        std::printf("%s\n", difference.c_str());
        same = false;
      }
    }
    if (!write.empty()) write_whole_file(write, page);
    std::printf(
        "%d runs, %.0f ms each; %d answers off by more than a degree or 60 cm, %d of them called good "
        "without the cause;\n%d of %d causes of those named; %d clean drives, %d false alarms\n",
        totals.runs, 1e3 * totals.seconds / std::max(1, totals.runs), totals.off, totals.silent, totals.named,
        totals.traced, totals.clean, totals.alarms);
    if (totals.silent > 0 || 100 * totals.alarms > totals.clean || 10 * totals.named < 9 * totals.traced ||
        !same)
      throw cli::Exit{1};
  });
  return program.run(argc, argv);
}
