// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The answers that count, of a log or of the processes that run.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "answers/answers.hpp"

namespace egocal::tools {

struct WantedAnswers {
  std::string pair;  ///< A,B; empty: the only one
  bool all = false;  ///< of all pairs; pair is empty
};

struct GatheredAnswers {
  std::vector<PairName> pairs;  ///< the one that was asked for, or all of them
  Answers answers;
  std::set<PairName> with_nominal{};  ///< as the rig file says, for answers whose problem is not received
};

/// Those at the end of a session that was recorded. Throws Error where the log has none, UsageError where
/// another pair is wanted.
GatheredAnswers answers_of_log(const std::string& log, const WantedAnswers& wanted);

/// Listens for answers. Solvers send their newest answer, and pairing its problem, again every second. What
/// is certified for a problem on the bus cannot be outdone but by newer problems; anything less is waited
/// with for `timeout` seconds. url: empty for the rig's. Empty where a signal has ended the wait.
std::optional<GatheredAnswers> heard_answers(const std::string& rig_file, const std::string& url,
                                             const WantedAnswers& wanted, double timeout);

}  // namespace egocal::tools
