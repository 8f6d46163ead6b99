// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

namespace egocal::bus {

struct AnswerAgeOptions {
  /// An answer is old when motions that it does not contain have arrived for this long [s]. A solver answers
  /// within milliseconds, and one that was killed is restarted within a second; the other four seconds are a
  /// margin for machines under load. Study: tests/e2e/chaos.cpp, whose solvers are killed all the time.
  double answered_within = 5;
};

/// Measures for how long newer problems have gone unanswered.
class AnswerAge {
 public:
  using Number = std::pair<std::int64_t, std::int64_t>;  ///< session and number of an answer

  /// Call it when a problem or an answer may be new. behind: the newest problem is newer than this answer.
  /// Each new answer restarts the time: a slow solver skips problems and still follows.
  void note(const Number& answer, bool behind, std::int64_t now_us);
  /// Call it when there is no answer, or none is expected.
  void forget() { behind_since_us_.reset(); }
  /// For how long newer problems have gone unanswered [s]; 0: the answer is current.
  double old(std::int64_t now_us, const AnswerAgeOptions& options) const;

 private:
  std::optional<std::int64_t> behind_since_us_;
  Number answer_{-1, -1};
};

}  // namespace egocal::bus
