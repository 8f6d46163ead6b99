// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/last_answers.hpp"

namespace egocal::tools {

bool LastAnswers::wait_on(int missing, bool has_work, Time now) {
  if (missing == 0) return false;
  if (!fewest_ || missing < *fewest_) {
    fewest_ = missing;
    fell_at_ = now;
    idle_ = {};
  } else if (!has_work) {
    idle_ += now - asked_at_;
  }
  asked_at_ = now;
  return idle_ < options_.stall && now - fell_at_ < options_.longest_stall;
}

}  // namespace egocal::tools
