// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/clock_step.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/lengths/not_a_move.hpp"
#include "diagnosis/explanations/times/clock.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/microseconds.hpp"
#include "statistics/quantile.hpp"

namespace egocal::detail {

namespace {

/// Two clocks, before and from `time` on [s since the first pose of a], with one extrinsic.
struct ClockStep {
  double time = 0, before = 0, after = 0;
  Explained explained{};
};

/// The parts of both streams on one side of a time.
struct PartOfDrive {
  Trajectory a, b;
  double shift = 0;  ///< from the first pose of the drive to that of the part [s]
};

PartOfDrive part_of_drive(const Evidence& evidence, double from, double to) {
  const Trajectory &a = evidence.streams.a, &b = evidence.streams.b;
  const std::int64_t origin_us = a.front().time_us;
  PartOfDrive part;
  const auto take = [&](const Trajectory& all, double offset, Trajectory& some) {
    const auto within = [&](const StampedPose& pose) {
      const double time = to_seconds(pose.time_us - origin_us) + offset;
      return time >= from && time < to;
    };
    // of a million poses a vector that grows would take twice the memory
    some.reserve(static_cast<std::size_t>(std::count_if(all.begin(), all.end(), within)));
    std::copy_if(all.begin(), all.end(), std::back_inserter(some), within);
  };
  take(a, 0, part.a);
  take(b, evidence.clock.offset, part.b);
  if (!part.a.empty()) part.shift = to_seconds(part.a.front().time_us - origin_us);
  return part;
}

Streams streams_of(const Evidence& evidence, const Trajectory& a, const Trajectory& b,
                   const std::vector<float>& turning_a, const std::vector<float>& turning_b) {
  const Streams& all = evidence.streams;
  Streams streams{a,           b,         all.read_a, all.read_b, all.max_gap, all.motion_length,
                  all.options, turning_a, turning_b,  all.each,   all.grid};
  streams.motion_length = evidence.stride * evidence.instants.period;
  // a long drive has more instants than a clock needs: a few in each motion
  streams.each =
      std::clamp<std::size_t>(evidence.instants.size() / all.options.clock.instants, 1,
                              std::max<std::size_t>(1, static_cast<std::size_t>(evidence.stride) / 8));
  return streams;
}

/// The clock that suits a part, with its motions on the clock of the drive.
std::optional<ClockFit> clock_of(const Evidence& evidence, const PartOfDrive& part,
                                 const ClockStepOptions& tuning) {
  if (part.a.size() < tuning.least_motions || part.b.size() < tuning.least_motions) return std::nullopt;
  const std::vector<float> turning_a = turning_of(part.a), turning_b = turning_of(part.b);
  std::optional<ClockFit> fit =
      fit_offset(streams_of(evidence, part.a, part.b, turning_a, turning_b), {evidence.clock.offset, 0, 0});
  if (!fit || fit->explained.motions.all.size() < tuning.least_motions) return std::nullopt;
  for (Motion& motion : fit->explained.motions.all) motion.time += part.shift;
  return fit;
}

std::optional<ClockStep> step_at(const Evidence& evidence, double time, const DiagnosisOptions& options,
                                 const ClockStepOptions& tuning) {
  const std::optional<ClockFit> before = clock_of(evidence, part_of_drive(evidence, -INFINITY, time), tuning),
                                after = clock_of(evidence, part_of_drive(evidence, time, INFINITY), tuning);
  if (!before || !after) return std::nullopt;
  ClockStep step{time, before->clock.offset, after->clock.offset};
  Motions& motions = step.explained.motions;
  motions = before->explained.motions;
  const Motions& later = after->explained.motions;
  motions.all.insert(motions.all.end(), later.all.begin(), later.all.end());
  motions.blocks = evidence.given.explained.motions.blocks;
  // in the units that the other explanations are compared in
  motions.rotation = evidence.given.explained.motions.rotation;
  motions.translation = evidence.given.explained.motions.translation;
  step.explained.fit = robust_fit(motions, options.fit);
  return step;
}

/// What each motion leaves at one of the two clocks, with its time.
std::vector<std::pair<double, double>> left_at(const Evidence& evidence, double offset,
                                               const ClockStep& step) {
  constexpr int shorter = 4;  // motions that cross the step fit neither clock: few, where they are short
  Streams streams =
      streams_of(evidence, evidence.streams.a, evidence.streams.b, evidence.turning_a, evidence.turning_b);
  streams.motion_length = std::max(1, evidence.stride / shorter) * evidence.instants.period;
  const Instants instants = synchronised(streams.a, streams.b, {offset, 0, 0}, streams.max_gap, streams.each,
                                         streams.options.motions);
  std::vector<std::pair<double, double>> result;
  if (instants.size() < 2 || !(instants.period > 0)) return result;
  const int stride = std::max(1, static_cast<int>(std::lround(streams.motion_length / instants.period)));
  Motions motions = motions_of(instants, streams.read_a, streams.read_b, stride,
                               2 * streams.options.motions.most, streams.options.motions);
  if (motions.all.empty()) return result;
  const RobustFit fit = evaluated(motions, step.explained.fit.T);
  for (std::size_t i = 0; i < motions.all.size(); ++i)
    result.emplace_back(motions.all[i].time, fit.squares[i]);
  return result;
}

/// The time that divides the drive best between the two clocks.
double best_time(const Evidence& evidence, const ClockStep& step) {
  std::vector<std::pair<double, double>> events;  // what it costs to have the time later than this
  const auto before = left_at(evidence, step.before, step), after = left_at(evidence, step.after, step);
  double floor = 0;
  for (const auto* left : {&before, &after}) {
    std::vector<std::pair<double, double>> values;
    for (const auto& [time, square] : *left) values.emplace_back(square, 1.0);
    const double typical = values.empty() ? 0 : weighted_median(std::move(values));
    floor = floor > 0 ? std::min(floor, typical) : typical;
  }
  if (!(floor > 0)) return step.time;
  for (const auto& [time, square] : before) events.emplace_back(time, std::log1p(square / floor));
  for (const auto& [time, square] : after) events.emplace_back(time, -std::log1p(square / floor));
  std::sort(events.begin(), events.end());
  double sum = 0, least = 0, best = step.time;
  for (std::size_t i = 0; i + 1 < events.size(); ++i) {
    sum += events[i].second;
    if (sum < least) {
      least = sum;
      best = 0.5 * (events[i].first + events[i + 1].first);
    }
  }
  return best;
}

std::optional<ClockStep> refined(const Evidence& evidence, double time, const DiagnosisOptions& options,
                                 const ClockStepOptions& tuning) {
  std::optional<ClockStep> step = step_at(evidence, time, options, tuning);
  for (int round = 1; step && round < tuning.rounds; ++round) {
    // most moves are no steps, and each round costs as much as the search for a constant offset
    if (!(compare(evidence.given.explained, step->explained).gain > tuning.promising * options.gain))
      return step;
    step = step_at(evidence, best_time(evidence, *step), options, tuning);
  }
  return step;
}

/// A stream whose stamps jump.
struct Jump {
  const char* whose;  ///< its mark
  double time;        ///< of the last pose before it [s since the first pose of a]
};

/// The jump of the stamps that is the step, where one of the streams has it near the step's time.
std::optional<Jump> jump_of(const Evidence& evidence, const ClockStep& step, const ClockStepOptions& tuning) {
  const auto jump = [&](const Trajectory& trajectory, double offset, double by) -> std::optional<double> {
    if (!(by > 0)) return std::nullopt;
    const double span = to_seconds(trajectory.back().time_us - trajectory.front().time_us),
                 period = (span - by) / static_cast<double>(trajectory.size() - 1),
                 near = evidence.stride * evidence.instants.period + by;
    for (std::size_t i = 1; i < trajectory.size(); ++i) {
      const StampedPose &before = trajectory[i - 1], &here = trajectory[i];
      const double time = to_seconds(before.time_us - evidence.streams.a.front().time_us) + offset,
                   gap = to_seconds(here.time_us - before.time_us);
      if (std::abs(time - step.time) < near && std::abs(gap - period - by) < tuning.same_jump * period)
        return time;
    }
    return std::nullopt;
  };
  const double by = step.after - step.before;
  if (const std::optional<double> time = jump(evidence.streams.b, step.before, -by))
    return Jump{"{b}", *time};
  if (const std::optional<double> time = jump(evidence.streams.a, 0, by)) return Jump{"{a}", *time};
  return std::nullopt;
}

Finding worded(const Evidence& evidence, const ClockStep& step, double gain, bool certain,
               const ClockStepOptions& tuning) {
  Finding finding;
  finding.code = "clock_step";
  finding.certain = certain;
  const std::optional<Jump> jump = jump_of(evidence, step, tuning);
  const double time = jump ? jump->time : step.time;
  finding.time = time;
  finding.value = step.after - step.before;
  finding.improvement = std::exp(gain);
  finding.T_a_b = to_pose(step.explained.fit.T);
  const char* how =
      certain ? (jump ? "jump" : "was set") : (jump ? "seem to jump" : "seems to have been set");
  FindingWords words;
  words.claim = format("%s %s at about %.1f s after the start, by %.3f s",
                       jump ? format("The stamps of %s", jump->whose).c_str() : "One of the clocks", how,
                       time, std::abs(*finding.value));
  words.evidence = format(
      ": %+.3f s has to be added to the stamps of {b} before, %+.3f s after it. One mounting then explains "
      "both "
      "parts%s.",
      step.before, step.after, certain ? "" : " as well as one for each does");
  words.scope = format("Before and after %.1f s, separately: ", time);
  words.cure = "{solve}--time-offset auto; synchronise the clocks, and do not set them during a drive.";
  say(finding, std::move(words));
  return finding;
}

/// Whether the step explains the motions better than one clock does. In the part whose clock is the one in
/// force it explains nothing, so that not all of the blocks can show it.
bool shown(const Comparison& comparison, const DiagnosisOptions& options, const ClockStepOptions& tuning) {
  return number_explains(comparison, options) ||
         (comparison.gain >= options.gain && comparison.sigmas >= tuning.sigmas);
}

/// Explanations that hold for parts of the drive only, or a clock for all of it.
bool may_be_a_step(const Finding& finding) {
  const std::string_view code = finding.code;
  return code == "mount_moved" || code == "scale_change" || code.starts_with("clock_") ||
         (code == "unrelated" && finding.time);
}

/// Whether the rotations of some tenths contradict the answer, as on the other clock they do.
bool contradicted_by_tenths(const Fit& fit, const ClockStepOptions& tuning) {
  std::vector<double> left;
  for (const FitTenth& tenth : fit.tenths)
    if (std::isfinite(tenth.rotation_median)) left.push_back(tenth.rotation_median);
  return !left.empty() && *std::max_element(left.begin(), left.end()) >
                              std::max(tuning.contradicts * quantile(left, 0.25), tuning.least_contradiction);
}

}  // namespace

void name_clock_step(const Evidence& evidence, const Fit& fit, const DiagnosisOptions& options,
                     std::vector<Finding>& findings, const ClockStepOptions& tuning) {
  std::vector<Finding> moves;
  double rival = 0;
  bool changes = contradicted_by_tenths(fit, tuning);
  for (const Finding& finding : findings) {
    if (!may_be_a_step(finding)) continue;
    changes = true;
    if (finding.code == "mount_moved" && finding.time) moves.push_back(finding);
    rival = std::max(rival, std::log(finding.improvement));
  }
  if (!changes) return;
  if (!moves.empty()) rival = std::max(rival, gain_of_parts(evidence, moves, options));
  const double length = to_seconds(evidence.streams.a.back().time_us - evidence.streams.a.front().time_us);
  std::vector<double> times;
  for (const Finding& move : moves) times.push_back(*move.time);
  for (std::size_t k = 1; moves.empty() && k <= tuning.places; ++k)
    times.push_back(length * static_cast<double>(k) / static_cast<double>(tuning.places + 1));
  std::optional<ClockStep> best;
  double gain = 0;
  for (const double time : times) {
    std::optional<ClockStep> step = refined(evidence, time, options, tuning);
    if (!step) continue;
    const Comparison comparison = compare(evidence.given.explained, step->explained);
    const double by = std::abs(step->after - step->before);
    if (!(comparison.gain > gain) || by < options.clock.least ||
        by < tuning.least_of_period * evidence.instants.period || !shown(comparison, options, tuning))
      continue;
    gain = comparison.gain;
    best = std::move(step);
  }
  if (!best) return;
  // the same division with a mounting for each part, whatever was found
  Finding divided;
  divided.time = best->time;
  rival = std::max(rival, gain_of_parts(evidence, {divided}, options));
  if (gain < rival - tuning.alike) return;
  const bool certain = gain > rival + tuning.alike;
  Finding finding = worded(evidence, *best, gain, certain, tuning);
  if (certain) std::erase_if(findings, may_be_a_step);
  findings.insert(certain ? findings.begin() : findings.end(), std::move(finding));
}

}  // namespace egocal::detail
