// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig/calibration.hpp"
#include "offline/drives/goal_of_drives.hpp"

#include <algorithm>
#include <mutex>
#include <numeric>

#include "arguments.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/scale/scale_statistics.hpp"
#include "offline/common/answer_or_warn.hpp"
#include "offline/common/beside.hpp"
#include "offline/common/with_nominal_part.hpp"
#include "offline/drives/append.hpp"
#include "offline/reading/log_trajectory.hpp"
#include "offline/reading/trajectory_source.hpp"
#include "offline/rig/clocks.hpp"
#include "offline/rig/joint.hpp"
#include "offline/rig/rig_findings.hpp"

namespace egocal::tools {

namespace {

/// Reads the sensors' first drive.
std::vector<Trajectory> read(const RigRequest& request, const RigSettings& settings, RigReport& report) {
  std::vector<Trajectory> trajectories;
  std::string damage;  // of the log, whichever channel is read
  for (const std::string& source : settings.sources) {
    if (request.log.empty()) {
      trajectories.push_back(read_noting(source, request.reading, report.warnings));
      continue;
    }
    LogTrajectory channel = read_log_trajectory(request.log, source);
    for (std::string* warning : {&channel.not_used, &channel.times})
      if (!warning->empty()) report.warnings.push_back(std::move(*warning));
    damage = std::move(channel.damage);
    trajectories.push_back(std::move(channel.poses));
  }
  if (!damage.empty()) report.warnings.push_back(damage);
  return trajectories;
}

/// Appends further drives, each after the ones before it.
Drives append_drives(const RigRequest& request, const RigSettings& settings,
                     std::vector<Trajectory>& trajectories, RigReport& report) {
  if (request.append.size() % trajectories.size() != 0)
    throw UsageError("--append: expected one file for each sensor");
  std::vector<Trajectory*> sensors;
  sensors.reserve(trajectories.size());
  for (Trajectory& trajectory : trajectories) sensors.push_back(&trajectory);
  Drives drives(sensors, settings.sources);
  for (std::size_t i = 0; i < request.append.size(); i += trajectories.size()) {
    const auto begin = request.append.begin() + static_cast<std::ptrdiff_t>(i);
    std::vector<std::string> names(begin, begin + static_cast<std::ptrdiff_t>(trajectories.size()));
    std::vector<Trajectory> drive;
    drive.reserve(names.size());
    for (const std::string& name : names)
      drive.push_back(read_noting(name, request.reading, report.warnings));
    drives.append(std::move(drive), std::move(names), report.warnings);
  }
  return drives;
}

/// Adds the finding that two offsets fit: which of them is right is open, and so is the answer.
void put_rival_offset(const ClockOfSensor& clock, const std::string& name, Calibration& calibration) {
  if (clock.period == 0) return;
  Finding finding;
  finding.code = "clock_offset";
  finding.message = rival_offsets_in_words(clock.period, name);
  finding.remedy = "Add some motion that does not repeat, or leave out --time-offset where the clocks agree.";
  if (calibration.verdict == Verdict::good) {
    calibration.verdict = Verdict::incomplete;
    calibration.reason = finding.message;
  }
  calibration.findings.push_back(std::move(finding));
}

/// Whether a sensor does not work: each pose is the first one.
bool is_still(const Trajectory& poses) {
  return std::all_of(poses.begin(), poses.end(), [&](const StampedPose& one) {
    return one.pose.real == poses.front().pose.real && one.pose.dual == poses.front().pose.dual;
  });
}

/// Why two streams are on clocks of their own.
std::string no_offset_in_words(const RigPairSettings& pair, const std::vector<Trajectory>& trajectories,
                               const std::vector<std::string>& names) {
  for (const std::size_t k : {pair.a, pair.b})
    if (is_still(trajectories[k]))
      return "time offset: cannot be estimated, the poses of " + names[k] +
             " are all the same: it does not work, or other columns are its poses";
  return "time offset: cannot be estimated, the streams are too short or never turn";
}

/// What became of a pair: an answer, or why it has none.
struct PairOutcome {
  std::optional<Calibration> calibration;
  std::vector<MountsDiffer> mounts;
  std::string reason;
  std::string note;  ///< what the answer does not use
};

/// One pair by itself, as if there were no others.
PairOutcome calibrate_pair(const RigPairSettings& pair, const std::vector<Trajectory>& trajectories,
                           const Drives& drives, const std::vector<ClockOfSensor>& clocks,
                           const std::vector<std::string>& names) {
  // first: without the offset calibrate() fails as well where the times do not overlap, and advises to have
  // it found, which was tried
  if (clocks[pair.a].group != clocks[pair.b].group)
    throw Error(no_offset_in_words(pair, trajectories, names));
  const Trajectory &a = trajectories[pair.a], &b = trajectories[pair.b];
  PairOutcome outcome;
  CalibrationOptions options = pair.calibration;
  Calibration& calibration = outcome.calibration.emplace(with_nominal_part(
      pair.nominal_part, pair.turned ? NominalOf::a_in_b : NominalOf::b_in_a, options,
      [&](const CalibrationOptions& of_run) { return calibrate(a, b, of_run); }, outcome.note));
  outcome.mounts = name_what_drives_differ_in(drives, pair.a, pair.b, a, b, options, calibration);
  count_driving_only(drives, calibration);
  calibration.time_offset_applied = clocks[pair.b].offset - clocks[pair.a].offset;
  for (const std::size_t k : {pair.a, pair.b}) put_rival_offset(clocks[k], names[k], calibration);
  return outcome;
}

/// All pairs, two at a time: they do not depend on each other.
std::vector<PairOutcome> calibrate_all(const RigSettings& settings,
                                       const std::vector<Trajectory>& trajectories, const Drives& drives,
                                       const std::vector<ClockOfSensor>& clocks,
                                       const std::function<void(double)>& progress) {
  std::vector<PairOutcome> outcomes(settings.pairs.size());
  std::mutex mutex;  // of the two below
  std::size_t next = 0, done = 0;
  const auto work = [&] {
    for (;;) {
      std::size_t i = 0;
      {
        const std::lock_guard lock(mutex);
        if (next == settings.pairs.size()) return;
        i = next++;
      }
      try {
        outcomes[i] = calibrate_pair(settings.pairs[i], trajectories, drives, clocks, settings.names);
      } catch (const AdvisedError& error) {
        const RigPairSettings& pair = settings.pairs[i];
        outcomes[i].reason = error.in_terms({settings.names[pair.a], settings.names[pair.b], {}});
      } catch (const Error& error) {
        outcomes[i].reason = error.what();
      }
      const std::lock_guard lock(mutex);
      ++done;
      if (progress) progress(static_cast<double>(done) / static_cast<double>(settings.pairs.size()));
    }
  };
  at_the_same_time(work, work);
  return outcomes;
}

std::string without_answer(const RigReport& report, const UnsolvedPair& pair) {
  return report.names[pair.a] + ", " + report.names[pair.b] + ": " + pair.reason;
}

/// The sensors outside of the largest group that the answers connect; of two groups that are as large the
/// first one counts.
std::vector<std::size_t> sensors_apart(const RigReport& report) {
  const std::size_t n = report.names.size();
  std::vector<std::size_t> group(n), size(n, 0), apart;
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (const RigPairAnswer& pair : report.solution.pairs)
    std::replace(group.begin(), group.end(), std::size_t{group[pair.b]}, std::size_t{group[pair.a]});
  for (const std::size_t g : group) ++size[g];
  const auto most = *std::max_element(group.begin(), group.end(),
                                      [&](std::size_t g, std::size_t h) { return size[g] < size[h]; });
  for (std::size_t s = 0; s < n; ++s)
    if (group[s] != most) apart.push_back(s);
  return apart;
}

void put_outcomes(std::vector<PairOutcome> outcomes, const RigSettings& settings, RigReport& report) {
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const RigPairSettings& pair = settings.pairs[i];
    if (!outcomes[i].calibration) {
      report.unsolved.push_back({pair.a, pair.b, outcomes[i].reason});
      continue;
    }
    if (!outcomes[i].note.empty())
      report.warnings.push_back(report.names[pair.a] + ", " + report.names[pair.b] + ": " + outcomes[i].note);
    Calibration& calibration = *outcomes[i].calibration;
    report.contradictory = report.contradictory || calibration.verdict == Verdict::contradictory;
    report.short_of_goal = report.short_of_goal || (calibration.goal && !calibration.goal->reached);
    for (MountsDiffer& differ : outcomes[i].mounts)
      report.mounts.push_back({report.pairs.size(), std::move(differ)});
    RigPairAnswer answer;
    answer.a = pair.a;
    answer.b = pair.b;
    answer.T_a_b = to_dual_quaternion(calibration.T_a_b);
    answer.certificate = calibration.certificate;
    report.solution.pairs.push_back(answer);
    report.truths.push_back(pair.truth);
    report.pairs.push_back(std::move(calibration));
  }
  if (report.pairs.empty()) throw Error(without_answer(report, report.unsolved.front()));
  report.apart = sensors_apart(report);
  for (const UnsolvedPair& pair : report.unsolved)
    report.warnings.push_back(report.names[pair.a] + ", " + report.names[pair.b] +
                              ": this pair has no answer of its own: " + pair.reason);
}

void answer_rig(const RigRequest& request, RigReport& report) {
  const RigSettings settings = rig_settings(request);
  report.names = settings.names;
  report.sources = settings.sources;
  std::vector<Trajectory> trajectories = read(request, settings, report);
  const Drives drives = append_drives(request, settings, trajectories, report);
  for (std::size_t k = 0; k < trajectories.size(); ++k)
    if (settings.scales[k] != 1) trajectories[k] = scaled(trajectories[k], settings.scales[k]);
  const std::vector<ClockOfSensor> clocks = synchronise(request, settings, drives, trajectories);
  for (std::size_t k = 0; k < clocks.size(); ++k)
    if (!clocks[k].drives.empty())
      report.warnings.push_back(
          report.names[k] + ": its clock differs between the drives: " + clocks_in_words(clocks[k].drives));
  put_outcomes(calibrate_all(settings, trajectories, drives, clocks, request.progress), settings, report);
  for (const RigPairSettings& pair : settings.pairs)
    if (std::none_of(report.unsolved.begin(), report.unsolved.end(),
                     [&](const UnsolvedPair& other) { return other.a == pair.a && other.b == pair.b; }))
      drives.require_motions(pair.a, pair.b, trajectories[pair.a], trajectories[pair.b],
                             pair.calibration.pairing);
  const CommonMotions motions = solve_jointly(trajectories, settings, report);
  find_in_rig(motions, trajectories, request, settings, report);
  choose_tree(report);
}

}  // namespace

RigReport calibrate_rig(const RigRequest& request) {
  return answer_or_warn(request, answer_rig);
}

}  // namespace egocal::tools
