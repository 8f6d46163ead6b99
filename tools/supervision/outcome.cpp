// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "egocal/bus/backing.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/in_words.hpp"
#include "egocal/io/extrinsic_text.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/scale/scale_drive.hpp"
#include "offline/reading/log_damage.hpp"

namespace egocal::tools {

namespace {

/// The log's end after what pairing has read, on the channel that has more of it [s].
double not_read(const bus::Rig& rig, const PairName& pair, const LogExtent& extent,
                const ReadUntil& read_until, const OutcomeOptions& options) {
  double most = 0;
  for (const std::string& name : {pair.first, pair.second}) {
    const auto stream = extent.sensors.find(name);
    const auto until = read_until.find(bus::sensor(rig, name).channel);
    if (stream != extent.sensors.end() && until != read_until.end())
      most = std::max(most, to_seconds(stream->second.last_us - until->second));
  }
  return most > options.least_missing ? most : 0;
}

/// The log after a sensor's clock went back [s], where the answer is of a session before that: such a session
/// begins with the first pose of the log.
double after_clock_went_back(const PairName& pair, const LogExtent& extent, std::int64_t session,
                             const OutcomeOptions& options) {
  double after = 0;
  bool first_session = false;
  for (const std::string& name : {pair.first, pair.second}) {
    const auto stream = extent.sensors.find(name);
    if (stream == extent.sensors.end()) continue;
    first_session = first_session || session == stream->second.begin_us;
    if (to_seconds(stream->second.earlier_us) > options.least_missing)
      after = std::max(after, to_seconds(stream->second.last_us - stream->second.first_us));
  }
  return first_session && after > options.least_missing ? after : 0;
}

/// What comes before the answer's statistics.
struct Begin {
  double seconds = 0;
  bool clock_went_back = false;
};

/// The part of the log before the answer's session. The session begins with a pose of either sensor, and its
/// number is the time of that pose; where the clocks of the sensors differ, the nearer one counts. A session
/// that began since a clock went back has a number that is no time, as numbers of sessions only grow: then
/// all of the log before is missing, at least.
Begin not_in_session(const PairName& pair, const LogExtent& extent, std::int64_t session,
                     const OutcomeOptions& options) {
  std::optional<double> least;
  double earlier = 0;
  for (const std::string& name : {pair.first, pair.second}) {
    const auto stream = extent.sensors.find(name);
    if (stream == extent.sensors.end()) continue;
    earlier = std::max(earlier, to_seconds(stream->second.earlier_us));
    if (const double late = to_seconds(session - stream->second.first_us); late >= 0)
      least = std::min(least.value_or(late), late);
  }
  if (earlier > options.least_missing) return {earlier, true};
  if (!(least.value_or(0) > options.least_missing)) return {};
  return {*least, false};
}

/// The log after the last motion of the pair, while both sensors send [s]: pairing rejected the rest, or knew
/// another rig by then.
double without_motion(const PairName& pair, const LogExtent& extent, const Answers& answers,
                      const OutcomeOptions& options) {
  const auto motions = answers.end_of_motions(pair);
  const auto a = extent.sensors.find(pair.first), b = extent.sensors.find(pair.second);
  if (!motions || a == extent.sensors.end() || b == extent.sensors.end()) return 0;
  const double of_a = to_seconds(a->second.last_us - motions->first),
               of_b = to_seconds(b->second.last_us - motions->first) + motions->second;
  return std::min(of_a, of_b) > options.standing ? std::min(of_a, of_b) : 0;
}

/// The longest time without a message of each sensor, where it is much longer than the time between two.
std::string silences_in_words(const LogExtent& extent, const OutcomeOptions& options) {
  std::string text;
  for (const auto& [name, stream] : extent.sensors) {
    const double silent = to_seconds(stream.silent_until_us - stream.silent_from_us);
    const double period = to_seconds(stream.last_us - stream.first_us + stream.earlier_us) /
                          static_cast<double>(std::max<std::int64_t>(1, stream.messages - 1));
    if (silent > std::max(options.standing, options.silent_periods * period))
      text += fmt::format("{}: no pose from {:.1f} to {:.1f} s of the log\n", name,
                          to_seconds(stream.silent_from_us), to_seconds(stream.silent_until_us));
  }
  return text;
}

/// What is missing between the first and the last motion of a pair.
struct Hole {
  double seconds = 0;         ///< of all of them
  double begin = 0, end = 0;  ///< of the largest one, or of the span that many small ones are spread over [s]
};

/// The poses from the begin of one motion to that of the next one.
double poses_per_motion(const bus::Rig& rig, const bus::PairConfig& config, double period) {
  if (!bus::unscaled_side(rig, config)) return 1;
  const ScaleDriveOptions options;
  return std::ceil(options.motion / static_cast<double>(options.starts) / std::max(period, 1e-6));
}

/// The hole in the middle of a pair's answer, as the log's poses show it: no motion was made of them, and
/// none was rejected. A motion that was rejected also costs the poses of the stride around it. Where the log
/// itself has a gap, nothing is missing.
Hole hole_in(const bus::Rig& rig, const bus::PairConfig& config, const LogExtent& extent,
             const Answers& answers, const OutcomeOptions& options) {
  const PairName pair{config.a, config.b};
  const auto a = extent.sensors.find(pair.first), b = extent.sensors.find(pair.second);
  const std::vector<Answers::Passed>& passed = answers.passed(pair);
  if (a == extent.sensors.end() || b == extent.sensors.end() || passed.size() < 2) return {};
  Hole hole;
  double all = 0, largest = 0;
  const auto into_log = [&](std::int64_t time_us) { return to_seconds(time_us - a->second.first_us); };
  for (std::size_t i = 1; i < passed.size(); ++i) {
    const Answers::Passed &from = passed[i - 1], &to = passed[i];
    const std::int64_t shift_us = to_microseconds(to.time_offset);
    const std::int64_t of_a = a->second.poses.between(from.utime, to.utime),
                       of_b = b->second.poses.between(from.utime - shift_us, to.utime - shift_us),
                       in_log = std::min(of_a, of_b);
    if (in_log == 0) continue;
    const double period = (of_a < of_b ? a : b)->second.poses.period();
    const auto motions = static_cast<double>(to.seq - from.seq),
               rejected = static_cast<double>(std::max<std::int64_t>(to.rejected - from.rejected, 0));
    const double known = motions * poses_per_motion(rig, config, period) +
                         rejected * static_cast<double>(std::max<std::int64_t>(to.stride, 1));
    const double seconds = (static_cast<double>(in_log) - known) * period;
    all += seconds;
    if (seconds <= options.standing) continue;
    hole.seconds += seconds;
    if (seconds <= largest) continue;
    largest = seconds;
    hole.begin = into_log(from.utime);
    hole.end = into_log(to.utime);
  }
  const double span = to_seconds(passed.back().utime - passed.front().utime);
  if (hole.seconds > 0 || all <= std::max(options.standing, options.least_part * span)) return hole;
  return {all, into_log(passed.front().utime), into_log(passed.back().utime)};
}

/// The judgement of a pair. What neither the answer (missing: how much, and why) nor the verdict knows of the
/// end of the drive comes first.
std::string judgement_of(const PairName& pair, const Answers& answers, const std::string& missing) {
  const Diagnosis* const diagnosis = answers.diagnosis(pair);
  const double rest = answers.judged_to_the_end(pair) ? 0 : answers.seconds_not_judged(pair).value_or(0);
  const std::string unjudged = rest > 0 ? fmt::format("the last {:.1f} s are not judged", rest) : "";
  std::string end = missing + (missing.empty() || unjudged.empty() ? "" : ", and ") + unjudged;
  if (const std::optional<bus::Departure> moved = answers.departure(pair))
    end += (end.empty() ? "" : ", and ") + bus::in_words(*moved);
  return end + (end.empty() ? "" : ". Before: ") + (diagnosis ? verdict_line(*diagnosis) : "not judged");
}

/// How much of the log's end is not in the answer, and why; empty: the answer knows the end of the log.
std::string missing_end(const PairName& pair, const Answers& answers, double unread, double after_clock) {
  if (after_clock > 0)
    return fmt::format(
        "old answer, the last {:.1f} s of the log are not in it (a sensor's clock went back, and no motion "
        "was found after that)",
        after_clock);
  const double unanswered = answers.seconds_not_answered(pair);
  if (answers.answered_to_the_end(pair) && unread == 0) return {};
  return fmt::format(
      "old answer, the last {:.1f} s of the log are not in it ({})", unanswered + unread,
      answers.answered_to_the_end(pair) ? "pairing did not read them" : "no solver answered them");
}

/// The lines of text about a pair that has an answer.
std::string line_of(const PairName& pair, const Answers& answers, const std::string& missing,
                    const Begin& begin, const Hole& hole, double without_motion) {
  const Answers::Best& best = *answers.best(pair);
  const bus::CheckedScale* const scale = answers.scale(pair);
  const Pose T = to_pose(best.checked.answer.T_a_b);
  const Eigen::Quaterniond& q = T.rotation;
  std::string text = fmt::format(
      "{} -> {}: {}\n  {}, {}; "
      "translation {:.4f} {:.4f} {:.4f} m, rotation w x y z {:.5f} {:.5f} {:.5f} {:.5f}\n",
      pair.first, pair.second, judgement_of(pair, answers, missing),
      answers.certified(pair) ? "optimal (proven)" : "not proven to be optimal",
      counted(static_cast<std::uint64_t>(best.message.pairs), "motion pair"), T.translation.x(),
      T.translation.y(), T.translation.z(), q.w(), q.x(), q.y(), q.z());
  if (begin.seconds > 0)
    text += fmt::format("  the first {:.1f} s of the log are not in this answer: {}\n", begin.seconds,
                        begin.clock_went_back ? "a sensor's clock went back, and the statistics began anew"
                                              : "its statistics begin after them");
  if (hole.seconds > 0)
    text += fmt::format(
        "  about {:.1f} s in the middle of the log are not in this answer, between {:.1f} and {:.1f} s: "
        "pairing did not get them, or was paused\n",
        hole.seconds, hole.begin, hole.end);
  if (without_motion > 0)
    text += fmt::format(
        "  the last {:.1f} s of the log are not in this answer: no new motion was found in them\n",
        without_motion);
  if (scale)
    text += fmt::format("  scale of {} {:.6g} +- {:.2g}, {}\n", scale->sensor, scale->solution.scale,
                        scale->solution.stddev,
                        scale->verified && scale->solution.certified ? "optimal (proven)" : "not proven");
  if (answers.lacks_scale(pair))
    text += "  the scale could not be verified: this answer holds at a scale that is not known\n";
  return text;
}

/// "NOT OBSERVABLE, not a measurement: z": numbers of the answer that the motions do not show.
std::string not_shown_of(const bus::PairConfig& config, const Answers& answers) {
  const PairName pair{config.a, config.b};
  const Answers::Best& best = *answers.best(pair);
  NamedExtrinsic extrinsic;
  extrinsic.parent = config.a;
  extrinsic.child = config.b;
  extrinsic.backing =
      bus::backing_of(best.checked, best.message.method, config.nominal.has_value(), answers.diagnosis(pair));
  const std::string words = not_shown_in_words(extrinsic);
  return words.empty() ? "" : "  " + words + "\n";
}

/// What the motions cannot rule out, once for all pairs of which it holds.
std::string possible_of_all(const bus::Rig& rig, const Answers& answers) {
  std::map<std::string, std::vector<std::string>> pairs_of;
  for (const bus::PairConfig& config : rig.pairs)
    if (const Diagnosis* const diagnosis = answers.diagnosis({config.a, config.b}))
      for (const std::string& line : possible_lines(*diagnosis))
        pairs_of[line].push_back(config.a + " -> " + config.b);
  std::string text;
  for (const auto& [line, pairs] : pairs_of)
    text += fmt::format("possible, {}: {}\n",
                        pairs.size() == 1 ? pairs[0] : fmt::format("{} pairs", pairs.size()), line);
  return text;
}

}  // namespace

Outcome outcome_of(const bus::Rig& rig, const Answers& answers, const LogExtent& extent,
                   const ReadUntil& read_until, const OutcomeOptions& options) {
  Outcome outcome;
  for (const bus::PairConfig& config : rig.pairs) {
    const PairName pair{config.a, config.b};
    const Answers::Best* const best = answers.best(pair);
    if (!best) {
      outcome.text += fmt::format("{} -> {}: no answer\n", pair.first, pair.second);
      continue;
    }
    const Diagnosis* const diagnosis = answers.diagnosis(pair);
    const std::int64_t session = best->message.session;
    const double after_clock = after_clock_went_back(pair, extent, session, options);
    const std::string missing =
        missing_end(pair, answers, not_read(rig, pair, extent, read_until, options), after_clock);
    outcome.answered = true;
    outcome.unusable = outcome.unusable || !missing.empty() || (diagnosis && unusable(*diagnosis)) ||
                       answers.departure(pair);
    outcome.text += line_of(pair, answers, missing,
                            after_clock > 0 ? Begin{} : not_in_session(pair, extent, session, options),
                            hole_in(rig, config, extent, answers, options),
                            missing.empty() ? without_motion(pair, extent, answers, options) : 0) +
                    not_shown_of(config, answers);
  }
  outcome.text += possible_of_all(rig, answers);
  outcome.text += silences_in_words(extent, options);
  for (const auto& [name, count] : extent.unreadable)
    outcome.text +=
        fmt::format("{}: {} of the log {} no pose that can be read\n", name,
                    counted(static_cast<std::uint64_t>(count), "message"), count == 1 ? "holds" : "hold");
  if (const std::string damage = damage_in_words(extent.damage); !damage.empty())
    outcome.text += damage + "\n";
  if (outcome.answered && extent.sensors.empty()) {
    outcome.unusable = true;
    outcome.text += "the log holds no poses any more: whether its end is in the answers is not known\n";
  }
  return outcome;
}

}  // namespace egocal::tools
