// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/bus_news.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "egocal/bus/plausible.hpp"
#include "egocal/bus/process.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::tools {

namespace {

std::string begin_of(const PairName& pair) {
  return pair.first + " -> " + pair.second + ": ";
}

}  // namespace

BusNews::BusNews(const bus::Rig& rig, const BusNewsOptions& options)
    : rig_(rig), options_(options), streams_(rig.sensors) {
  for (const bus::PairConfig& pair : rig.pairs) pairs_[{pair.a, pair.b}];
}

void BusNews::hear(const status_t& status, std::int64_t now_us) {
  hear_error(status, now_us);
  if (status.role != bus::role_name(bus::Role::pairing) ||
      status.state == bus::state_name(bus::State::waiting))
    return;
  const bool paused = status.state == bus::state_name(bus::State::paused);
  if (pairing_.empty() || paused != pairing_paused_)
    for (auto& [name, pair] : pairs_) pair.motion_us = now_us;
  pairing_ = status.name;
  pairing_paused_ = paused;
  count_rejections(status, now_us);
}

void BusNews::count_rejections(const status_t& status, std::int64_t now_us) {
  const std::string prefix = "rejected: ";
  for (const counter_t& counter : status.counters) {
    if (!counter.name.starts_with(prefix)) continue;
    const std::string reason = bus::printable(counter.name.substr(prefix.size()), 100);
    if (rejected_.size() >= most_reasons && !rejected_.contains(reason)) continue;
    Rejected& rejected = rejected_[reason];
    // less than before: pairing was started anew. Counts may be anything.
    if (counter.value > rejected.count) {
      rejected.growth = counter.value - std::max<std::int64_t>(rejected.count, 0);
      rejected.grown_us = now_us;
    }
    rejected.count = counter.value;
  }
}

/// What pairing rejects most of at present, and what to do about it; empty: nothing.
std::string BusNews::mostly_rejected(std::int64_t now_us) const {
  const std::pair<const std::string, Rejected>* most = nullptr;
  for (const auto& entry : rejected_)
    if (entry.second.growth > (most ? most->second.growth : 0) &&
        seconds_between(entry.second.grown_us, now_us) < options_.pairing_silent)
      most = &entry;
  if (!most) return {};
  const std::string cure = bus::cure_of_rejection(most->first);
  return most->first + (cure.empty() ? "" : ": " + cure);
}

std::string BusNews::why_nothing() const {
  constexpr std::size_t most_named = 2;  // the others are rarer, and often follow from these
  if (std::any_of(pairs_.begin(), pairs_.end(), [](const auto& pair) { return pair.second.newest; }))
    return {};
  std::vector<std::pair<std::int64_t, std::string>> counts;
  for (const auto& [reason, rejected] : rejected_)
    if (rejected.count > 0) counts.emplace_back(rejected.count, reason);
  std::stable_sort(counts.begin(), counts.end(),
                   [](const auto& x, const auto& y) { return x.first > y.first; });
  std::string text;
  for (std::size_t i = 0; i < counts.size() && i < most_named; ++i) {
    std::string cure = bus::cure_of_rejection(counts[i].second);
    if (cure.ends_with('.')) cure.pop_back();
    text += fmt::format("{}{} x {}{}", i == 0 ? ": it rejected " : ", ", counts[i].first, counts[i].second,
                        cure.empty() ? "" : " (" + cure + ")");
  }
  return "pairing found no motion" + text;
}

/// Takes an error of pairing or of the diagnosis, such as a state that cannot be saved, which otherwise only
/// a monitor shows. Errors of solvers and the player pass by themselves.
void BusNews::hear_error(const status_t& status, std::int64_t now_us) {
  if (status.role != bus::role_name(bus::Role::pairing) &&
      status.role != bus::role_name(bus::Role::diagnosis))
    return;
  // one that lets its namesake work says nothing of that one's errors
  if (status.last_error.empty() && status.state == bus::state_name(bus::State::waiting)) return;
  Error& error = errors_[status.role];
  Complaint heard;
  error.heard = status.run;
  if (!status.last_error.empty()) {
    error.complained = status.run;
    heard = {bus::printable(status.name, 40), bus::printable(status.last_error, 400)};
  }
  if (heard == error.now) return;
  error.now = std::move(heard);
  error.since_us = now_us;
}

std::string BusNews::errors(std::int64_t now_us) {
  std::string text;
  for (auto& [role, error] : errors_) {
    if (error.now == error.reported) continue;
    if (error.now.text.empty()) {
      if (seconds_between(error.since_us, now_us) < options_.over_after) continue;
      const bool restarted = error.heard != error.complained;
      text += error.reported.process +
              (restarted ? ": since its restart it no longer reports: " : ": this is over: ") +
              error.reported.text + "\n";
    } else {
      const auto before = reported_us_.find(error.now.line());
      if (before == reported_us_.end() ? reported_us_.size() >= most_errors
                                       : seconds_between(before->second, now_us) < options_.repeat_report)
        continue;
      reported_us_[error.now.line()] = now_us;
      text += error.now.line() + "\n";
    }
    error.reported = error.now;
  }
  return text;
}

void BusNews::hear(const problem_t& problem, std::int64_t now_us) {
  const auto found = pairs_.find({problem.sensor_a, problem.sensor_b});
  if (found == pairs_.end()) return;
  Pair& pair = found->second;
  const std::pair number(problem.session, problem.seq);
  const bool first_or_back = seconds_between(pair.problem_us, now_us) > options_.pairing_silent;
  const bool is_new =
      !pair.newest || pair.newest->first != number.first || pair.newest->second < number.second;
  if (is_new || first_or_back) pair.motion_us = now_us;
  if (is_new && pair.paused_us && seconds_between(*pair.paused_us, now_us) > options_.settle)
    pair.paused_us.reset();  // it was resumed, or the command was lost
  if (is_new && std::exchange(pair.standing_reported, false))
    pending_ += begin_of(found->first) + "new motions come again\n";
  pair.newest = number;
  pair.problem_us = now_us;
}

void BusNews::hear(const command_t& command, std::int64_t now_us) {
  if (command.to != "*" && command.to != pairing_) return;
  const bool pause = command.verb == "pause";
  if (!pause && command.verb != "resume") return;
  for (auto& [name, pair] : pairs_) {
    const bool all = command.sensor_a.empty() && command.sensor_b.empty();
    if (!all && (command.sensor_a != name.first || command.sensor_b != name.second)) continue;
    pair.paused_us = pause ? std::optional(now_us) : std::nullopt;
    pair.motion_us = now_us;
  }
}

void BusNews::hear(const std::string& channel, bus::Bytes bytes, std::int64_t now_us) {
  streams_.hear(channel, bytes, now_us);
}

std::string BusNews::lines(const Answers& answers, std::int64_t now_us) {
  std::string text = errors(now_us) + std::exchange(pending_, {});
  for (const bus::PairConfig& config : rig_.pairs) {
    const PairName name{config.a, config.b};
    Pair& pair = pairs_[name];
    text += unanswered(pair, name, answers, now_us) + standing(pair, name, now_us);
  }
  return text;
}

std::string BusNews::unanswered(Pair& of, const PairName& pair, const Answers& answers,
                                std::int64_t now_us) const {
  const Answers::Best* const best = answers.best(pair);
  const auto number = best ? bus::AnswerAge::Number{best->message.session, best->message.seq}
                           : bus::AnswerAge::Number{-1, -1};
  of.age.note(number, !answers.answered_to_the_end(pair), now_us);
  const bool old = of.age.old(now_us, options_.answer_age) > 0;
  if (old == std::exchange(of.unanswered_reported, old)) return {};
  return begin_of(pair) + (old ? fmt::format("no solver answers the motions of the last {:g} s\n",
                                             options_.answer_age.answered_within)
                               : "a solver answers again\n");
}

std::string BusNews::standing(Pair& of, const PairName& pair, std::int64_t now_us) const {
  const double since = seconds_between(of.motion_us, now_us);
  if (of.standing_reported || since <= options_.standing) return {};
  if (of.standing_reported_us && seconds_between(*of.standing_reported_us, now_us) < options_.repeat_report)
    return {};
  const std::string why = why_standing(of, pair, now_us);
  if (why.empty()) return {};
  of.standing_reported = true;
  of.standing_reported_us = now_us;
  return begin_of(pair) +
         (of.newest ? fmt::format("no new motion for {:.0f} s: ", since) : std::string("no motion yet: ")) +
         why + "\n";
}

/// Why a pair has no new motion; empty: that is how it should be, or it is not known.
std::string BusNews::why_standing(const Pair& of, const PairName& pair, std::int64_t now_us) const {
  if (pairing_.empty() || pairing_paused_ || of.paused_us) return {};
  const auto silent = [&](const std::string& name) {
    return std::none_of(streams_.sensors().begin(), streams_.sensors().end(),
                        [&](const bus::SensorStream& stream) {
                          return stream.sensor.name == name && stream.heard &&
                                 now_us - stream.heard->last_mono_us <= streams_.options().silent_us;
                        });
  };
  const bool both = silent(pair.first) && silent(pair.second);
  if (both && !options_.live) return {};
  const bool none = silent(pair.first) || silent(pair.second);
  if (!of.newest && !none && seconds_between(of.motion_us, now_us) <= options_.first_motion) return {};
  if (of.newest && seconds_between(of.problem_us, now_us) > options_.pairing_silent) return {};
  std::string why =
      both ? pair.first + " and " + pair.second + " send nothing"
           : bus::why_no_motion(streams_, pair.first, pair.second, now_us, mostly_rejected(now_us));
  if (!of.newest && none) why += "; `egocal listen` shows what is sent instead";
  return why;
}

}  // namespace egocal::tools
