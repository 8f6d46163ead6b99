// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "egocal/bus/plausible.hpp"
#include "egocal/directions.hpp"
#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "wire_checks.hpp"

namespace egocal::bus {

namespace {

/// Characters of a reason or a remedy: two long sentences.
constexpr std::size_t max_sentence = 400;

constexpr const char* self_contradiction = "verdict that contradicts itself";

/// Part of a standard deviation that rounding takes from a root of a sum of squares, generously.
constexpr double added_by_rounding = 1e-9;

/// What cannot be a number on the wire is none.
double finite_or_zero(double value) {
  return std::isfinite(value) ? value : 0;
}

bool sentence(const std::string& text) {
  return printable(text, max_sentence) == text;
}

finding_t to_message(const Finding& finding, std::int64_t begin_us) {
  finding_t message{};
  message.code = finding.code;
  message.certain = finding.certain;
  message.message = printable(finding.message, max_sentence);
  message.remedy = printable(finding.remedy, max_sentence);
  message.improvement = finite_or_zero(finding.improvement);
  if (finding.time) message.utime = begin_us + to_microseconds(*finding.time);
  if (finding.value) {
    message.has_value = 1;
    message.value = finite_or_zero(*finding.value);
  }
  message.quat[0] = 1;
  if (finding.T_a_b) {
    message.has_answer = 1;
    set_pose(to_dual_quaternion(*finding.T_a_b), message.pos, message.quat);
  }
  return message;
}

Checked<Finding> to_finding(const finding_t& message, std::int64_t begin_us) {
  if (!plausible_name(message.code)) return {{}, "finding without a code"};
  if (!sentence(message.message) || !sentence(message.remedy)) return {{}, "text of a finding"};
  if (!finite_not_negative({message.improvement}) || !std::isfinite(message.value))
    return {{}, "finding out of range"};
  if (message.utime != 0 && !plausible_time(message.utime)) return {{}, "time of a finding out of range"};
  Finding finding;
  finding.code = message.code;
  finding.certain = message.certain != 0;
  finding.message = message.message;
  finding.remedy = message.remedy;
  finding.improvement = message.improvement;
  if (message.utime != 0) finding.time = to_seconds(message.utime - begin_us);
  if (message.has_value) finding.value = message.value;
  if (message.has_answer) {
    const Checked<DualQuaternion> T = to_dual_quaternion(message.pos, message.quat);
    if (!T) return {{}, "answer of a finding: " + T.reason};
    finding.T_a_b = to_pose(*T.value);
  }
  return {std::move(finding), {}};
}

Checked<Fit> to_fit(const fit_t& message) {
  if (!plausible_count(message.poses) ||
      !finite_not_negative({message.motion_seconds, message.rotation_median, message.rotation_95,
                            message.translation_median, message.translation_95,
                            message.translation_relative_median, message.length_ratio,
                            message.turning_ratio}))
    return {{}, "fit out of range"};
  Fit fit;
  fit.motion_seconds = message.motion_seconds;
  fit.rotation_median = message.rotation_median;
  fit.rotation_95 = message.rotation_95;
  fit.translation_median = message.translation_median;
  fit.translation_95 = message.translation_95;
  fit.translation_relative_median = message.translation_relative_median;
  fit.length_ratio = message.length_ratio;
  fit.turning_ratio = message.turning_ratio;
  return {std::move(fit), {}};
}

void set_observability(const Diagnosis& diagnosis, const Judged& judged, verdict_t& message) {
  for (std::size_t i = 0; i < 6; ++i) {
    message.observable[i] = judged.observability.observable[i];
    message.stddev[i] = judged.observability.stddev[i];
    message.stddev_added[i] = diagnosis.assumed[i] ? std::numeric_limits<double>::infinity()
                                                   : finite_or_zero(diagnosis.timing_stddev[i]);
  }
}

/// Why the message cannot mean what it says; empty: it can.
std::string take_observability(const verdict_t& message, ReceivedVerdict& received) {
  Observability& observability = received.judged.observability;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!not_negative({message.stddev[i], message.stddev_added[i]})) return "standard deviation out of range";
    observability.observable[i] = message.observable[i] != 0;
    observability.stddev[i] = message.stddev[i];
    received.diagnosis.assumed[i] = std::isinf(message.stddev_added[i]);
    if (received.diagnosis.assumed[i] && observability.observable[i]) return self_contradiction;
    // a sender may have added the squares in another way
    if (observability.stddev[i] < (1 - added_by_rounding) * message.stddev_added[i])
      return self_contradiction;
    if (!received.diagnosis.assumed[i]) received.diagnosis.timing_stddev[i] = message.stddev_added[i];
  }
  return directions_contradict(message.observable, message.stddev) ? self_contradiction : "";
}

/// Whether the verdict is good although of an observable direction no motion says how well it is known.
bool good_but_unknown(Verdict verdict, const Observability& observability) {
  if (verdict != Verdict::good) return false;
  for (std::size_t i = 0; i < 6; ++i)
    if (observability.observable[i] && std::isinf(observability.stddev[i])) return true;
  return false;
}

/// The words of "z yaw"; empty: one of them is no direction, or comes twice.
std::optional<std::vector<std::string>> directions_in(const std::string& text) {
  std::vector<std::string> words;
  if (text.empty()) return words;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    std::string word = text.substr(begin, end - begin);
    if (std::find(std::begin(direction_names), std::end(direction_names), word) ==
            std::end(direction_names) ||
        std::find(words.begin(), words.end(), word) != words.end())
      return std::nullopt;
    words.push_back(std::move(word));
    begin = end + 1;
  }
  return words;
}

}  // namespace

Observability Judged::unknown() {
  Observability result;
  result.stddev.fill(std::numeric_limits<double>::infinity());
  return result;
}

std::optional<Verdict> verdict_from_name(const std::string& text) {
  for (const Verdict verdict :
       {Verdict::good, Verdict::incomplete, Verdict::doubtful, Verdict::contradictory})
    if (to_string(verdict) == text) return verdict;
  return std::nullopt;
}

verdict_t to_message(const Diagnosis& diagnosis, const Judged& judged) {
  verdict_t message{};
  message.verdict = to_string(diagnosis.verdict);
  message.reason = printable(diagnosis.reason, max_sentence);
  set_pose(judged.T_a_b, message.pos, message.quat);
  set_observability(diagnosis, judged, message);
  message.utime_begin = judged.begin_us;
  message.utime_end = judged.end_us;
  const Fit& fit = diagnosis.fit;
  message.fit.poses = judged.poses;
  message.fit.motion_seconds = finite_or_zero(fit.motion_seconds);
  message.fit.rotation_median = finite_or_zero(fit.rotation_median);
  message.fit.rotation_95 = finite_or_zero(fit.rotation_95);
  message.fit.translation_median = finite_or_zero(fit.translation_median);
  message.fit.translation_95 = finite_or_zero(fit.translation_95);
  message.fit.translation_relative_median = finite_or_zero(fit.translation_relative_median);
  message.fit.length_ratio = finite_or_zero(fit.length_ratio);
  message.fit.turning_ratio = finite_or_zero(fit.turning_ratio);
  const std::size_t findings = std::min(diagnosis.findings.size(), max_findings);
  for (std::size_t i = 0; i < findings; ++i)
    message.findings.push_back(to_message(diagnosis.findings[i], judged.begin_us));
  message.n_findings = static_cast<std::int32_t>(findings);
  message.goal_seconds_left = -1;
  if (!diagnosis.goal) return message;
  const Goal& goal = *diagnosis.goal;
  message.has_goal = 1;
  message.goal_reached = goal.reached;
  for (const std::string& direction : goal.missing)
    message.goal_missing += (message.goal_missing.empty() ? "" : " ") + direction;
  message.goal_seconds_left =
      goal.seconds_left && std::isfinite(*goal.seconds_left) ? *goal.seconds_left : -1;
  message.next = printable(goal.next, max_sentence);
  return message;
}

Checked<ReceivedVerdict> to_verdict(const verdict_t& message) {
  for (const std::int64_t time : {message.utime, message.session, message.utime_begin, message.utime_end})
    if (!plausible_time(time)) return {{}, "time out of range"};
  if (!plausible_count(message.seq) || !plausible_count(message.pairs)) return {{}, "count out of range"};
  if (!plausible_name(message.sensor_a) || !plausible_name(message.sensor_b)) return {{}, "sensor name"};
  if (!plausible_name(message.sender)) return {{}, "name of the sender"};
  const std::optional<Verdict> verdict = verdict_from_name(message.verdict);
  if (!verdict) return {{}, "unknown verdict"};
  if (!sentence(message.reason) || !sentence(message.next)) return {{}, "text of a verdict"};
  if (message.findings.size() > max_findings) return {{}, "too many findings"};
  const Checked<DualQuaternion> T = to_dual_quaternion(message.pos, message.quat);
  if (!T) return {{}, T.reason};
  const Checked<Fit> fit = to_fit(message.fit);
  if (!fit) return {{}, fit.reason};
  std::optional<std::vector<std::string>> missing = directions_in(message.goal_missing);
  if (!missing || !std::isfinite(message.goal_seconds_left)) return {{}, "goal out of range"};

  ReceivedVerdict received;
  received.judged = {*T.value, message.utime_begin, message.utime_end, message.fit.poses};
  if (std::string reason = take_observability(message, received); !reason.empty())
    return {{}, std::move(reason)};
  if (good_but_unknown(*verdict, received.judged.observability)) return {{}, self_contradiction};
  Diagnosis& diagnosis = received.diagnosis;
  diagnosis.verdict = *verdict;
  diagnosis.reason = message.reason;
  diagnosis.fit = *fit.value;
  for (const finding_t& entry : message.findings) {
    Checked<Finding> finding = to_finding(entry, message.utime_begin);
    if (!finding) return {{}, finding.reason};
    diagnosis.findings.push_back(std::move(*finding.value));
  }
  if (message.has_goal) {
    Goal& goal = diagnosis.goal.emplace();
    goal.reached = message.goal_reached != 0;
    goal.missing = std::move(*missing);
    if (message.goal_seconds_left >= 0) goal.seconds_left = message.goal_seconds_left;
    goal.next = message.next;
    if (goal.reached != goal.missing.empty()) return {{}, self_contradiction};
  }
  if (diagnosis.goal && !diagnosis.goal->reached && *verdict == Verdict::good)
    return {{}, self_contradiction};
  return {std::move(received), {}};
}

}  // namespace egocal::bus
