// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Hours of simulated driving, judged again and again as egocal-diagnosis does it: false alarms of moved
// mounts, verdicts, and the delay until a move is shown (docs/moves.md). Every drive has its own seed and is
// one line of a record, so hours add up over several runs. Exit code 1 if a fixed mount raises an alarm.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/diagnosing.hpp"
#include "drive_record.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/online/answer.hpp"
#include "support/simulated_drive.hpp"
#include "support/standing.hpp"

namespace {

using namespace egocal;
using testing::Random;

constexpr double rate = 10;  // [Hz]
constexpr double degree = std::numbers::pi / 180;

/// A sort of drive.
struct Sort {
  const char* name;
  bool heavy_tails = false, wandering = false, outliers = false, flat = false, stops = false, bump = false;
};
constexpr Sort sorts[] = {{"white"},
                          {"heavy", true},
                          {"wandering", false, true},
                          {"outliers", false, false, true},
                          {"flat", false, false, false, true},
                          {"stops", false, false, false, false, true},
                          {"bump", false, false, false, false, false, true}};

/// What one drive showed.
struct Outcome {
  int looks = 0;
  int alarms = 0;         ///< looks that called the mount moved, of a bump those before it
  int episodes = 0;       ///< alarms after a look without
  int doubtful = 0;       ///< looks from the second minute on, without an alarm
  int contradictory = 0;  ///< the same
  double shown = -1;      ///< from a bump to the first look that names it [s]; negative: never
  int missed = 0;         ///< looks after that one that do not name it
};

testing::Streams drive(const Sort& sort, double minutes, double noise, Random& random) {
  SimulationOptions options;
  options.terrain = sort.flat ? Terrain::flat : random.uniform() < 0.5 ? Terrain::rough : Terrain::free;
  options.poses = static_cast<int>(60 * rate * minutes) + 1;
  options.rate = rate;
  options.relative_noise = noise;
  options.heavy_tails = sort.heavy_tails;
  options.random_walk = sort.wandering;
  options.seed = random.bits();
  options.faults.resize(2);
  if (sort.outliers) options.faults[1].outliers = 0.05;
  if (sort.bump)
    options.faults[1].mount_changes = {
        {30 * minutes,
         30 * minutes,
         {rotation_exp(0.5 * degree * random.direction()), 0.03 * random.direction()}}};
  testing::Streams streams = testing::simulated_drive(options);
  if (!sort.stops) return streams;
  // a traffic light every two minutes, of 10 s to a minute; the odometries repeat their poses or jitter
  const double jitter = random.uniform() < 0.5 ? 0 : 1e-4;
  for (std::size_t at = 600; at + 1 < streams.a.size(); at += 1200) {
    const auto periods = static_cast<std::int64_t>(random.uniform(10, 60) * rate);
    for (Trajectory* stream : {&streams.a, &streams.b})
      *stream =
          testing::with_stand(*stream, at, periods, static_cast<std::int64_t>(1e6 / rate), jitter, random);
    at += static_cast<std::size_t>(periods);
  }
  return streams;
}

/// The looks at one drive. Poses, their thinning, the problem and the judgement are those of the processes.
Outcome outcome_of(const Sort& sort, double minutes, double noise, double every, double chance, bool show,
                   Random random) {
  const testing::Streams streams = drive(sort, minutes, noise, random);
  const services::DiagnosingOptions live;
  DiagnosisOptions options;
  options.mount.false_alarms = chance;
  options.mount.shown_before = live.shown_before;
  MotionPairing pairing(streams.options);
  services::DriveSample sample(live.sample);
  Outcome outcome;
  double next = every;
  bool alarmed = false;
  for (std::size_t i = 0; i < std::min(streams.a.size(), streams.b.size()); ++i) {
    for (const Side side : {Side::a, Side::b}) {
      const StampedPose& pose = side == Side::a ? streams.a[i] : streams.b[i];
      pairing.push(side, pose);
      sample.push(side, pose);
    }
    const double time = 1e-6 * static_cast<double>(streams.a[i].time_us - streams.a[0].time_us);
    if (time < next) continue;
    next += every;
    const Problem problem = pairing.problem();
    if (problem.blocks.empty() || sample.poses(Side::a).size() < live.unseen.least_poses) continue;
    const Answer answer = solve(problem, Method::dual);
    Answered answered;
    answered.T_a_b = answer.T_a_b;
    answered.observability = answer.observability;
    answered.problem = problem;
    answered.stride = pairing.choice().stride;
    answered.seconds = time;
    const Diagnosis diagnosis =
        diagnose(sample.poses(Side::a), sample.poses(Side::b), pairing.options(), answered, options);
    const auto found =
        std::find_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                     [](const Finding& finding) { return finding.code == "mount_moved" && finding.certain; });
    const bool moved = found != diagnosis.findings.end();
    if (moved && show) std::printf("  %s at %.0f s: %s\n", sort.name, time, found->message.c_str());
    ++outcome.looks;
    if (sort.bump && time >= 30 * minutes) {
      if (moved && outcome.shown < 0) outcome.shown = time - 30 * minutes;
      outcome.missed += outcome.shown >= 0 && !moved;
      continue;
    }
    outcome.alarms += moved;
    outcome.episodes += moved && !alarmed;
    alarmed = moved;
    if (moved || time < 60) continue;
    outcome.doubtful += diagnosis.verdict == Verdict::doubtful;
    outcome.contradictory += diagnosis.verdict == Verdict::contradictory;
  }
  return outcome;
}

std::string to_line(const Outcome& o) {
  char line[160];
  std::snprintf(line, sizeof line, "%d %d %d %d %d %.3f %d", o.looks, o.alarms, o.episodes, o.doubtful,
                o.contradictory, o.shown, o.missed);
  return line;
}
std::optional<Outcome> from_line(const std::string* line) {
  Outcome o;
  if (line == nullptr || std::sscanf(line->c_str(), "%d %d %d %d %d %lf %d", &o.looks, &o.alarms, &o.episodes,
                                     &o.doubtful, &o.contradictory, &o.shown, &o.missed) != 7)
    return std::nullopt;
  return o;
}

/// Number of looks with a false alarm.
int report(const Sort& sort, const std::vector<Outcome>& outcomes, double minutes) {
  Outcome sum;
  int drives_with_alarm = 0, shown = 0, late = 0;
  std::vector<double> delays;
  for (const Outcome& o : outcomes) {
    sum.looks += o.looks;
    sum.alarms += o.alarms;
    sum.episodes += o.episodes;
    sum.doubtful += o.doubtful;
    sum.contradictory += o.contradictory;
    sum.missed += o.missed;
    drives_with_alarm += o.alarms > 0;
    shown += o.shown >= 0;
    late += o.shown > 15;
    if (o.shown >= 0) delays.push_back(o.shown);
  }
  std::printf(
      "%-10s %4zu drives, %6.1f h, %7d looks: %d false alarms in %d drives (%d looks), doubtful %d, "
      "contradictory %d",
      sort.name, outcomes.size(), static_cast<double>(outcomes.size()) * minutes / 60, sum.looks,
      sum.episodes, drives_with_alarm, sum.alarms, sum.doubtful, sum.contradictory);
  if (sort.bump) {
    std::sort(delays.begin(), delays.end());
    std::printf("; shown in %d, after %.0f s (median), later than 15 s in %d; %d looks without it afterwards",
                shown, delays.empty() ? 0 : delays[delays.size() / 2], late, sum.missed);
  }
  std::printf("\n");
  return sum.alarms;
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program app("live_study",
                   "hours of driving, judged again and again as egocal-diagnosis does it: false alarms, "
                   "verdicts, and how soon a moved mount is shown; exit code 1 where there is a false alarm");
  int drives = 4;
  double chance = services::DiagnosingOptions().false_alarms;
  double minutes = 60, noise = 0.01, every = 2;
  std::uint64_t seed = 1;
  std::vector<std::string> only, names;
  for (const Sort& sort : sorts) names.emplace_back(sort.name);
  std::string path;
  bool show = false;
  app.add_option("--drives", drives, "of each sort").show_default();
  app.add_option("--minutes", minutes, "of each drive, without its stops").show_default();
  app.add_option("--noise", noise, "of each motion, as a part of it").show_default();
  app.add_option("--every", every, "seconds between two looks; a look takes 70 ms of 4 % of a core")
      .show_default();
  app.add_option("--chance", chance, "of a false alarm in a look").show_default();
  app.add_option("--only", only, "sorts of drives").check(egocal::cli::Check::one_of(names));
  app.add_option("--seed", seed, "of the drives").show_default();
  app.add_option("--record", path, "file of one line a drive, which is continued");
  app.add_flag("--show", show, "each look that calls the mount moved");
  if (const auto code = app.parse(argc, argv)) return *code;
  char settings[120];
  std::snprintf(settings, sizeof settings, "live_study seed %llu minutes %g noise %g every %g chance %g",
                static_cast<unsigned long long>(seed), minutes, noise, every, chance);
  bench::DriveRecord record("live_study", path, settings);
  int alarms = 0;
  for (std::size_t s = 0; s < std::size(sorts); ++s) {
    const Sort& sort = sorts[s];
    if (!only.empty() && std::find(only.begin(), only.end(), sort.name) == only.end()) continue;
    std::vector<Outcome> outcomes;
    for (int k = 0; k < drives; ++k) {
      if (const std::optional<Outcome> known = from_line(record.known(sort.name, k))) {
        outcomes.push_back(*known);
        continue;
      }
      outcomes.push_back(
          outcome_of(sort, minutes, noise, every, chance, show, bench::random_of_drive(seed, s, k)));
      record.add(sort.name, k, to_line(outcomes.back()));
    }
    alarms += report(sort, outcomes, minutes);
    std::fflush(stdout);
  }
  return alarms > 0 ? 1 : 0;
}
