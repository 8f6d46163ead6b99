// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How the model explains motions that do not follow each other in time, and the counts that rise meanwhile:
// by a fault of a stream, or by a pause or a seek of the user.
#include <algorithm>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "answer_text.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/model.hpp"
#include "egocal/pairing/outcome.hpp"

namespace egocal::monitor {

namespace {

// bounds for a forged status, so that sums of its counts do not overflow
constexpr std::int64_t most_counted = std::int64_t{1} << 50, most_jumps = 100;

std::string tenths(double seconds) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.1f s", seconds);
  return buffer;
}

/// Whether the stream had a gap, by the mean distance of the motions between two problems. Problems that were
/// skipped are no gap.
bool is_gap(const problem_t& before, const problem_t& message, double max_gap) {
  if (message.seq <= before.seq) return false;
  const double motions = static_cast<double>(message.seq) - static_cast<double>(before.seq);
  const double stride = std::clamp(message.stride, 1, 1000);
  return seconds_between(before.utime, message.utime) > max_gap * (stride + motions - 1);
}

/// Counters of pairing and of the diagnosis that rise where the time of the log jumps.
bool rises_with_a_jump(const std::string& counter) {
  static const std::set<std::string> names{"lost",
                                           "rejected: duplicate",
                                           "rejected: too late",
                                           "rejected: time or number jumps",
                                           "rejected: " + std::string(to_string(Rejection::gap)),
                                           "rejected: " + std::string(to_string(Rejection::no_partner)),
                                           "rejected: " + std::string(to_string(Rejection::out_of_order))};
  return names.contains(counter);
}

/// Whether a player has sought, whenever that was.
bool has_sought(const std::vector<ProcessState>& processes) {
  return std::any_of(processes.begin(), processes.end(), [](const ProcessState& p) {
    return p.status.role == bus::role_name(Role::player) && p.seeks > 0;
  });
}

/// What was counted so far comes of a seek, or cannot be told from it.
void excuse_all(ProcessState& process) {
  for (auto& [name, tally] : process.tallies) {
    const std::int64_t shown = tally.newest - tally.excused;
    tally.excused = tally.newest;
    (name == "lost" ? process.lost : process.rejected) -= shown;
    std::erase_if(process.rejections,
                  [&](const bus::Refusal& refusal) { return name == "rejected: " + refusal.reason; });
  }
}

}  // namespace

void Model::interrupt(PairState& pair, Interruption::Kind kind, int jumps, Now now) {
  const bool again = pair.interruption && pair.interruption->kind == kind && kind == Interruption::Kind::seek;
  const int before = again ? pair.interruption->jumps : 0;
  pair.interruption = {kind, std::min(jumps + before, static_cast<int>(most_jumps)), now.mono_us};
  excused_mono_us_ = now.mono_us + to_microseconds(options_.excused);
}

/// Keeps an interruption up: a pause lasts, and so does a seek of a paused player, which has not sent
/// anything yet.
void Model::watch_interruptions(Now now) {
  const bool player_paused = std::any_of(processes_.begin(), processes_.end(), [](const ProcessState& p) {
    return p.alive && p.status.role == bus::role_name(Role::player) && p.state == bus::State::paused;
  });
  for (PairState& pair : pairs_) {
    const bool paused = pair_is_paused(*this, pair);
    if (paused && !pair.interruption) interrupt(pair, Interruption::Kind::pause, 1, now);
    if (!pair.interruption || !(paused || player_paused)) continue;
    pair.interruption->mono_us = now.mono_us;
    excused_mono_us_ = now.mono_us + to_microseconds(options_.excused);
  }
}

/// Judges the step between the measured times of two problems of a session: a gap, a jump back, or neither.
void Model::watch_time(PairState& pair, const problem_t& message, Now now) {
  const std::string name = pair_name(pair.a, pair.b);
  const double step = seconds_between(pair.problem.utime, message.utime);
  std::optional<Interruption>& interruption = pair.interruption;
  const bool paused = pair_is_paused(*this, pair), back = step < 0;
  // the first problem after a seek has no new motion, as the motion across the seek was rejected
  const bool jump =
      interruption && !paused && step > options_.max_gap * std::clamp<double>(message.stride, 1, 1000);
  const bool gap = !back && (jump || is_gap(pair.problem, message, options_.max_gap));
  if (back && interruption && interruption->kind == Interruption::Kind::seek) {
    note(Severity::info, name, "went back by " + tenths(-step) + ", by a seek of the player", now);
  } else if (back) {
    note(Severity::warning, name, "time ran backwards in the problems of one session", now);
  } else if (gap && interruption) {
    note(Severity::info, name,
         interruption->kind == Interruption::Kind::pause
             ? "paused for " + tenths(step) + " of the drive"
             : "skipped " + tenths(step) + " of the drive, by a seek of the player",
         now);
  } else if (gap) {
    ++pair.gap_count;
    note(Severity::warning, name, "gap of " + tenths(step) + " in the stream", now);
  }
  if (!interruption || paused) return;
  // what was on its way before comes first, and shows no jump
  const bool over = message.seq > pair.problem.seq &&
                    seconds_between(interruption->mono_us, now.mono_us) > options_.excused;
  if (over || ((back || gap) && --interruption->jumps <= 0)) interruption.reset();
}

void Model::note_new_session(PairState& pair, std::int64_t session, Now now) {
  const bool sought = pair.interruption && pair.interruption->kind == Interruption::Kind::seek;
  const bool asked = pair.reset_asked == pair.session;
  note(sought || asked ? Severity::info : Severity::warning, pair_name(pair.a, pair.b),
       sought && session < pair.problem.utime ? "the player went back: the calibration starts again"
       : sought || asked                      ? "session reset, as asked for: the calibration starts again"
                                              : "session reset: the calibration starts again",
       now);
  if (sought && --pair.interruption->jumps <= 0) pair.interruption.reset();
  pair.reset_asked.reset();
}

/// A player counts its seeks, whoever asked for them.
void Model::watch_seeks(ProcessState& process, const status_t& message, bool is_first, Now now) {
  if (message.role != bus::role_name(Role::player)) return;
  const auto counter = std::find_if(message.counters.begin(), message.counters.end(),
                                    [](const counter_t& one) { return one.name == "seeks"; });
  const std::int64_t seeks =
      counter == message.counters.end() ? 0 : std::clamp<std::int64_t>(counter->value, 0, most_counted);
  const std::int64_t more = seeks - process.seeks;
  process.seeks = seeks;
  // what it did before this monitor came is of no concern, but for what the others have counted since
  if (is_first && seeks > 0)
    for (ProcessState& other : processes_) excuse_all(other);
  if (is_first || more <= 0) return;
  for (PairState& pair : pairs_)
    interrupt(pair, Interruption::Kind::seek, static_cast<int>(std::min(more, most_jumps)), now);
}

/// Sums of lost and rejected messages, without those that a pause or a seek explains, and the reasons of the
/// others.
void Model::count_messages(ProcessState& process, const status_t& message, bool is_new, Now now) {
  process.in = process.out = process.lost = process.rejected = 0;
  const bool sought = has_sought(processes_);
  for (const counter_t& counter : message.counters) {
    std::int64_t value = std::clamp(counter.value, -most_counted, most_counted);
    if (rises_with_a_jump(counter.name)) {
      ProcessState::Tally& tally = process.tallies[counter.name];
      if (is_new ? sought : now.mono_us < excused_mono_us_)
        tally.excused += std::max<std::int64_t>(0, value - tally.newest);
      tally.newest = value;
      tally.excused = std::clamp<std::int64_t>(tally.excused, 0, std::max<std::int64_t>(0, value));
      value -= tally.excused;
    }
    const auto add = [&](std::int64_t& sum) { sum = std::min(sum + value, std::int64_t{1} << 60); };
    if (counter.name == "in") add(process.in);
    if (counter.name == "out") add(process.out);
    if (counter.name.starts_with("lost") || counter.name.starts_with("dropped")) add(process.lost);
    if (counter.name.starts_with("rejected")) add(process.rejected);
    if (const std::string prefix = "rejected: "; value > 0 && counter.name.starts_with(prefix))
      watch_rejections(process, counter.name.substr(prefix.size(), max_text), value, now);
  }
}

}  // namespace egocal::monitor
