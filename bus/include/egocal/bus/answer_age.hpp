// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

namespace egocal::bus {

struct AnswerAgeOptions {
  /// An answer is old where motions have come for this time that it does not know [s]. A solver answers
  /// within milliseconds, and one that was killed is back within a second; of the 5 s four are a margin for
  /// machines under load. Study: tests/e2e/chaos.cpp, whose solvers are killed all the time.
  double answered_within = 5;
};

/// How long ago the answer that counts was one of the present.
class AnswerAge {
 public:
  using Number = std::pair<std::int64_t, std::int64_t>;  ///< session and number of an answer

  /// To be called where a problem or an answer may be new. behind: problems have come that this answer does
  /// not know. Each new answer starts the time anew: a solver that is slow skips problems and still follows.
  void note(const Number& answer, bool behind, std::int64_t now_us);
  /// There is no answer, or none is awaited.
  void forget() { behind_since_us_.reset(); }
  /// For so long nothing has answered what came since [s]; 0: the answer is one of the present.
  double old(std::int64_t now_us, const AnswerAgeOptions& options) const;

 private:
  std::optional<std::int64_t> behind_since_us_;
  Number answer_{-1, -1};
};

}  // namespace egocal::bus
