// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "answers/answers.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/diagnosis/as_judged.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::tools {

namespace {

constexpr std::size_t most_pairs = bus::AnswerCheck::max_pairs;  // a limit on memory
/// Problems in a row that are older than the newest one before they are believed: one may be late.
constexpr int confirmations = 3;

/// The last session of each pair in a log: that of the pair's last problem, or of its last answer where the
/// log holds no problems of it. A higher session is not always a later one: two pairing processes may have
/// sent for a moment.
class LastSessions {
 public:
  void hear(const problem_t& message) { set(problems_, message); }
  void hear(const calibration_t& message) { set(answers_, message); }
  void hear(const verdict_t&) {}
  void hear(const scale_problem_t&) {}
  void hear(const scale_t&) {}
  template <class Message>
  bool is_last(const Message& message) const {
    const PairName pair{message.sensor_a, message.sensor_b};
    const auto& sessions = problems_.contains(pair) ? problems_ : answers_;
    const auto entry = sessions.find(pair);
    return entry != sessions.end() && entry->second == message.session;
  }

 private:
  using Sessions = std::map<PairName, std::int64_t>;
  template <class Message>
  static void set(Sessions& sessions, const Message& message) {
    const PairName pair{message.sensor_a, message.sensor_b};
    if (sessions.size() < most_pairs || sessions.contains(pair)) sessions[pair] = message.session;
  }
  Sessions problems_, answers_;
};

/// All problems, answers and verdicts of a log, in its order.
template <class Hear>
void read(const std::string& file, Hear hear) {
  bus::LogReader log(file);
  const auto hear_as = [&](auto message, const bus::LogEvent& event) {
    if (bus::decode(event.data, message)) hear(message);
  };
  while (const std::optional<bus::LogEvent> event = log.next())
    if (event->channel.starts_with(bus::problem_prefix))
      hear_as(problem_t{}, *event);
    else if (event->channel.starts_with(bus::calibration_prefix))
      hear_as(calibration_t{}, *event);
    else if (event->channel.starts_with(bus::verdict_prefix))
      hear_as(verdict_t{}, *event);
    else if (event->channel.starts_with(bus::scale_problem_prefix))
      hear_as(scale_problem_t{}, *event);
    else if (event->channel.starts_with(bus::scale_prefix))
      hear_as(scale_t{}, *event);
}

}  // namespace

std::string text(const PairName& pair) {
  return pair.first + "," + pair.second;
}

void Answers::expect_scales(const bus::Rig& rig) {
  for (const bus::PairConfig& pair : rig.pairs)
    if (bus::unscaled_side(rig, pair)) unscaled_.insert({pair.a, pair.b});
}

void Answers::hear(const problem_t& message) {
  if (!check_.take(message).empty()) return;
  note(message);
  const auto early = early_.find({message.sensor_a, message.sensor_b});
  if (early == early_.end() || early->second.session != message.session || early->second.seq != message.seq)
    return;
  const calibration_t answer = std::move(early->second);
  early_.erase(early);
  hear(answer);
}

void Answers::hear(const calibration_t& message) {
  const PairName pair{message.sensor_a, message.sensor_b};
  bus::CheckedAnswer checked = check_.check(message);
  if (checked.standing == bus::Standing::refused) {
    ++refused_[checked.reason];
    return;
  }
  if (!best_.contains(pair) && best_.size() >= most_pairs) return;
  if (checked.standing == bus::Standing::unverified) early_[pair] = message;
  consider(pair, {message, std::move(checked)});
}

void Answers::hear(const verdict_t& message) {
  const PairName pair{message.sensor_a, message.sensor_b};
  bus::Checked<bus::ReceivedVerdict> received = bus::to_verdict(message);
  if (!received) {
    ++refused_[received.reason];
    return;
  }
  if (const std::string reason = check_.refusal(message, *received.value); !reason.empty()) {
    ++refused_[reason];
    return;
  }
  const auto known = judgements_.find(pair);
  if (known == judgements_.end() && judgements_.size() >= most_pairs) return;
  if (known != judgements_.end() && known->second.session == message.session &&
      known->second.seq > message.seq)
    return;
  judgements_[pair] = {message.session, message.seq, message.utime, std::move(received.value->diagnosis),
                       received.value->judged};
}

void Answers::hear(const scale_problem_t& message) {
  if (const std::string refused = scales_.take(message); !refused.empty())
    ++refused_[refused];
  else
    unscaled_.insert({message.sensor_a, message.sensor_b});
}

void Answers::hear(const scale_t& message) {
  if (const std::string refused = scales_.take(message); !refused.empty()) ++refused_[refused];
}

const bus::CheckedScale* Answers::scale(const PairName& pair) const {
  const Best* answer = best(pair);
  return answer ? scales_.find(pair.first, pair.second, answer->message.session) : nullptr;
}

bool Answers::lacks_scale(const PairName& pair) const {
  const bus::CheckedScale* const known = scale(pair);
  return unscaled_.contains(pair) && !(known && known->verified);
}

bool Answers::certified(const PairName& pair) const {
  const Best* const answer = best(pair);
  return answer && answer->certified() && !lacks_scale(pair);
}

const Answers::Judgement* Answers::judgement(const PairName& pair) const {
  const Best* answer = best(pair);
  const auto entry = judgements_.find(pair);
  return answer && entry != judgements_.end() && entry->second.session == answer->message.session
             ? &entry->second
             : nullptr;
}

const Diagnosis* Answers::diagnosis(const PairName& pair) const {
  const Judgement* const known = judgement(pair);
  return known ? &known->diagnosis : nullptr;
}

Observability Answers::observability(const PairName& pair) const {
  const Observability& stated = best(pair)->checked.answer.observability;
  const Judgement* const known = judgement(pair);
  return known ? as_judged(stated, known->diagnosis) : stated;
}

std::optional<bus::Departure> Answers::departure(const PairName& pair) const {
  const Judgement* const known = judgement(pair);
  if (!known) return std::nullopt;
  return bus::departure(known->diagnosis.verdict, known->judged, to_pose(best(pair)->checked.answer.T_a_b));
}

/// The diagnosis judges again where it has poses of so much more of the drive (DiagnosingOptions::pose_step).
constexpr std::int64_t judged_again_us = 2'500'000;

bool Answers::judged_to_the_end(const PairName& pair) const {
  const Judgement* const known = judgement(pair);
  const auto newest = newest_.find(pair);
  if (!known || newest == newest_.end()) return known != nullptr;
  // on a busy machine the diagnosis may have the newest problem before the poses that the problem was made of
  const bool by_old_poses =
      known->judged.poses > 0 && newest->second.utime - known->judged.end_us > judged_again_us;
  return known->session == newest->second.session && known->seq >= newest->second.seq && !by_old_poses;
}

std::optional<double> Answers::seconds_not_judged(const PairName& pair) const {
  const Judgement* const known = judgement(pair);
  if (!known) return {};
  const auto newest = newest_.find(pair);
  if (newest == newest_.end() || newest->second.session != known->session) return 0;
  const std::int64_t until_us =
      known->judged.poses > 0 ? std::min(known->utime, known->judged.end_us) : known->utime;
  return to_seconds(std::max<std::int64_t>(0, newest->second.utime - until_us));
}

bool Answers::answered_to_the_end(const PairName& pair) const {
  const auto newest = newest_.find(pair);
  if (newest == newest_.end()) return true;
  const Best* const answer = best(pair);
  return answer && answer->message.session == newest->second.session &&
         answer->message.seq >= newest->second.seq;
}

double Answers::seconds_not_answered(const PairName& pair) const {
  if (answered_to_the_end(pair)) return 0;
  const Newest& newest = newest_.at(pair);
  const Best* const answer = best(pair);
  const bool same_session = answer && answer->message.session == newest.session;
  // a session is named by the time at which it began
  const std::int64_t from = same_session ? answer->message.utime : newest.session;
  return to_seconds(std::max<std::int64_t>(0, newest.utime - from));
}

std::optional<std::pair<std::int64_t, double>> Answers::end_of_motions(const PairName& pair) const {
  const auto newest = newest_.find(pair);
  if (newest == newest_.end()) return std::nullopt;
  return std::pair(newest->second.utime, newest->second.time_offset);
}

bool unusable(const Diagnosis& diagnosis) {
  return diagnosis.verdict == Verdict::contradictory || (diagnosis.goal && !diagnosis.goal->reached);
}

namespace {

/// What a doubtful verdict is about; null where a finding is certain, or none is there.
const Finding* named_as_possible(const Diagnosis& diagnosis) {
  const auto certain = [](const Finding& finding) { return finding.certain; };
  const std::vector<Finding>& findings = diagnosis.findings;
  return diagnosis.verdict < Verdict::doubtful || findings.empty() ||
                 std::any_of(findings.begin(), findings.end(), certain)
             ? nullptr
             : &findings.front();
}

}  // namespace

std::string verdict_line(const Diagnosis& diagnosis) {
  std::string line = std::string(to_string(diagnosis.verdict)) + ": " + diagnosis.reason;
  for (const Finding& finding : diagnosis.findings)
    if (finding.certain)
      line += (finding.message == diagnosis.reason ? "" : " " + finding.message) + " Cure: " + finding.remedy;
  if (const Finding* const possible = named_as_possible(diagnosis))
    line += (possible->message == diagnosis.reason ? "" : " Possible: " + possible->message) +
            " Cure: " + possible->remedy;
  if (diagnosis.goal) {
    line += diagnosis.goal->reached ? " Goal: reached." : " Goal: missing";
    for (const std::string& direction : diagnosis.goal->missing) line += " " + direction;
    if (!diagnosis.goal->reached) line += ".";
    if (!diagnosis.goal->next.empty()) line += " " + diagnosis.goal->next;
  }
  return line;
}

std::vector<std::string> possible_lines(const Diagnosis& diagnosis) {
  std::vector<std::string> lines;
  for (const Finding& finding : diagnosis.findings)
    if (!finding.certain && &finding != named_as_possible(diagnosis))
      lines.push_back(finding.message + " Cure: " + finding.remedy);
  return lines;
}

void Answers::note(const problem_t& message) {
  const PairName pair{message.sensor_a, message.sensor_b};
  if (newest_.size() >= most_pairs && !newest_.contains(pair)) return;
  Newest& newest = newest_[pair];
  const bool older = std::tie(message.session, message.seq) < std::tie(newest.session, newest.seq);
  newest.older_in_a_row = older ? newest.older_in_a_row + 1 : 0;
  if (older && newest.older_in_a_row < confirmations) return;
  if (newest.session != message.session) {
    newest.passed.clear();
    newest.passed_step_us = Newest{}.passed_step_us;
  }
  newest.session = message.session;
  newest.seq = message.seq;
  newest.utime = message.utime;
  newest.time_offset = message.time_offset;
  newest.older_in_a_row = 0;
  note_passed(message, newest);
}

/// The last entry of `passed` is always the newest problem.
void Answers::note_passed(const problem_t& message, Newest& newest) {
  constexpr std::size_t most_passed = 20'000;  // a limit on memory
  std::vector<Passed>& passed = newest.passed;
  // a session is named by the time at which it began
  if (passed.empty()) passed.push_back({message.session, 0, 0, message.stride, message.time_offset});
  while (!passed.empty() && (passed.back().seq > message.seq || passed.back().utime > message.utime))
    passed.pop_back();
  const bool replaces =
      passed.size() > 1 && message.utime - passed[passed.size() - 2].utime < newest.passed_step_us;
  if (replaces) passed.pop_back();
  passed.push_back({message.utime, message.seq, message.rejected, message.stride, message.time_offset});
  if (passed.size() <= most_passed) return;
  for (std::size_t i = 0; i < passed.size() / 2; ++i) passed[i] = passed[2 * i];
  passed[passed.size() / 2] = passed.back();
  passed.resize(passed.size() / 2 + 1);
  newest.passed_step_us *= 2;
}

const std::vector<Answers::Passed>& Answers::passed(const PairName& pair) const {
  static const std::vector<Passed> none;
  const auto newest = newest_.find(pair);
  return newest == newest_.end() ? none : newest->second.passed;
}

/// Whether an answer is to a problem that is no longer the newest although it has the higher number.
bool Answers::is_ahead(const PairName& pair, const calibration_t& message) const {
  const auto newest = newest_.find(pair);
  return newest != newest_.end() &&
         std::tie(message.session, message.seq) > std::tie(newest->second.session, newest->second.seq);
}

void Answers::consider(const PairName& pair, Best candidate) {
  const auto entry = best_.find(pair);
  if (entry == best_.end())
    best_.emplace(pair, std::move(candidate));
  else if (is_ahead(pair, candidate.message) != is_ahead(pair, entry->second.message)) {
    if (is_ahead(pair, entry->second.message) && candidate.checked.standing == bus::Standing::verified)
      entry->second = std::move(candidate);
  } else if (bus::outranks(rank_of(candidate.checked, candidate.message),
                           rank_of(entry->second.checked, entry->second.message)))
    entry->second = std::move(candidate);
}

const Answers::Best* Answers::best(const PairName& pair) const {
  const auto entry = best_.find(pair);
  return entry == best_.end() ? nullptr : &entry->second;
}

Answers recorded_answers(const std::string& log) {
  LastSessions last;
  read(log, [&](const auto& message) { last.hear(message); });
  Answers answers;
  read(log, [&](const auto& message) {
    if (last.is_last(message)) answers.hear(message);
  });
  return answers;
}

}  // namespace egocal::tools
