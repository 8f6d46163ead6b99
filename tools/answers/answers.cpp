// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "answers/answers.hpp"

#include <optional>

#include "egocal/bus/log_file.hpp"

namespace egocal::tools {

namespace {

constexpr std::size_t most_pairs = bus::AnswerCheck::max_pairs;
constexpr const char* problem_prefix = "EGOCAL_PROBLEM_";
constexpr const char* calibration_prefix = "EGOCAL_CALIBRATION_";

/// Of each pair the session of the last problem in a log; where it holds no problems, of the last answer. A
/// higher session is not always a later one: two pairing processes may have sent for a moment.
class LastSessions {
 public:
  void hear(const problem_t& message) { set(problems_, message); }
  void hear(const calibration_t& message) { set(answers_, message); }
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

template <class OnProblem, class OnAnswer>
void read(const std::string& file, OnProblem on_problem, OnAnswer on_answer) {
  bus::LogReader log(file);
  while (const std::optional<bus::LogEvent> event = log.next()) {
    problem_t problem{};
    calibration_t answer{};
    if (event->channel.starts_with(problem_prefix) && bus::decode(event->data, problem))
      on_problem(problem);
    else if (event->channel.starts_with(calibration_prefix) && bus::decode(event->data, answer))
      on_answer(answer);
  }
}

}  // namespace

std::string text(const PairName& pair) {
  return pair.first + "," + pair.second;
}

void Answers::hear(const problem_t& message) {
  if (!check_.take(message).empty()) return;
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

void Answers::consider(const PairName& pair, Best candidate) {
  const auto entry = best_.find(pair);
  if (entry == best_.end())
    best_.emplace(pair, std::move(candidate));
  else if (bus::outranks(rank_of(candidate.checked, candidate.message),
                         rank_of(entry->second.checked, entry->second.message)))
    entry->second = std::move(candidate);
}

const Answers::Best* Answers::best(const PairName& pair) const {
  const auto entry = best_.find(pair);
  return entry == best_.end() ? nullptr : &entry->second;
}

Answers recorded_answers(const std::string& log) {
  LastSessions last;
  read(
      log, [&](const problem_t& problem) { last.hear(problem); },
      [&](const calibration_t& answer) { last.hear(answer); });
  Answers answers;
  const auto hear = [&](const auto& message) {
    if (last.is_last(message)) answers.hear(message);
  };
  read(log, hear, hear);
  return answers;
}

}  // namespace egocal::tools
