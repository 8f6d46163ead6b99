// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/answer_age.hpp"

#include "egocal/microseconds.hpp"

namespace egocal::bus {

void AnswerAge::note(const Number& answer, bool behind, std::int64_t now_us) {
  if (!behind) return forget();
  if (behind_since_us_ && answer == answer_) return;
  behind_since_us_ = now_us;
  answer_ = answer;
}

double AnswerAge::old(std::int64_t now_us, const AnswerAgeOptions& options) const {
  if (!behind_since_us_) return 0;
  const double behind = seconds_between(*behind_since_us_, now_us);
  return behind > options.answered_within ? behind : 0;
}

}  // namespace egocal::bus
