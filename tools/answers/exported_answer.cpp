// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "answers/exported_answer.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "egocal/bus/backing.hpp"
#include "egocal/bus/departure.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

/// Where more of the drive than this has no verdict or no answer, a warning is due [s]: a pair alone is
/// judged every two seconds.
constexpr double longest_behind = 10;

bool is_current(const PairName& pair, const Answers& answers, bool live) {
  return !live || (answers.best(pair)->checked.standing == bus::Standing::verified &&
                   answers.seconds_not_answered(pair) <= longest_behind);
}

/// Sets what the verdict makes of an answer, and that it makes nothing of it where it is about another one.
void judge(const PairName& pair, const Answers& answers, NamedExtrinsic& extrinsic) {
  const Diagnosis* const diagnosis = answers.diagnosis(pair);
  if (!diagnosis) return;
  if (const std::optional<bus::Departure> moved = answers.departure(pair)) {
    extrinsic.usable = false;
    extrinsic.reason = bus::in_words(*moved);
    say(fmt::format("egocal: {}: {}. Before: {}", text(pair), extrinsic.reason, verdict_line(*diagnosis)));
    return;
  }
  if (diagnosis->verdict != Verdict::good)
    say(fmt::format("egocal: {}: {}", text(pair), verdict_line(*diagnosis)));
  extrinsic.usable = extrinsic.usable && diagnosis->verdict != Verdict::contradictory;
  extrinsic.verdict = to_string(diagnosis->verdict);
  extrinsic.reason = diagnosis->reason;
}

}  // namespace

bool may_be_used(const PairName& pair, const Answers& answers, bool live) {
  const Diagnosis* const diagnosis = answers.diagnosis(pair);
  return !(diagnosis && unusable(*diagnosis)) && !answers.departure(pair) && is_current(pair, answers, live);
}

NamedExtrinsic exported_answer(const PairName& pair, const GatheredAnswers& gathered, bool live) {
  const Answers& answers = gathered.answers;
  const Answers::Best& best = *answers.best(pair);
  const bus::CheckedScale* const scale = answers.scale(pair);
  const Answer& answer = best.checked.answer;
  if (best.checked.standing == bus::Standing::unverified)
    say(fmt::format("egocal: warning: {}: this answer could not be verified: its problem was not received{}",
                    text(pair),
                    live ? ", so pairing is silent and the answer may be old; it is marked unusable" : ""));
  else if (!best.certified())
    say(fmt::format("egocal: warning: {}: this answer is not certified", text(pair)));
  if (answers.lacks_scale(pair))
    say(fmt::format(
        "egocal: warning: {}: the scale of this answer could not be verified: it was not received",
        text(pair)));
  if (const double rest = answers.seconds_not_answered(pair); rest > longest_behind)
    say(fmt::format("egocal: warning: {}: the last {:.0f} s of the drive are not in this answer", text(pair),
                    rest));
  if (const double rest = answers.seconds_not_judged(pair).value_or(0); rest > longest_behind)
    say(fmt::format("egocal: warning: {}: the last {:.0f} s of the drive are not judged", text(pair), rest));
  NamedExtrinsic extrinsic{pair.first,
                           pair.second,
                           to_pose(answer.T_a_b),
                           answers.certified(pair),
                           best.message.pairs,
                           answers.observability(pair).stddev};
  extrinsic.usable = is_current(pair, answers, live);
  judge(pair, answers, extrinsic);
  extrinsic.backing = bus::backing_of(best.checked, best.message.method, gathered.with_nominal.contains(pair),
                                      answers.diagnosis(pair));
  if (const std::string not_shown = not_shown_in_words(extrinsic); !not_shown.empty())
    say(fmt::format("egocal: {}: {}", text(pair), not_shown));
  if (scale)
    extrinsic.scale = NamedScale{scale->sensor, scale->solution.scale, scale->solution.stddev,
                                 scale->verified && scale->solution.certified};
  return extrinsic;
}

}  // namespace egocal::tools
