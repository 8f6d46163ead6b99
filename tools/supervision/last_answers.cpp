// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/last_answers.hpp"

namespace egocal::tools {

bool LastAnswers::wait_on(int missing, bool has_work, Time now) {
  if (missing == 0) return false;
  if (!begun()) begun_at_ = now;
  const bool rises_count = now - begun_at_ < options_.longest_stall;  // or two senders would hold us for ever
  if (!begun() || missing < *missing_ || (missing > *missing_ && rises_count)) {
    missing_ = missing;
    news_at_ = now;
    idle_ = {};
  } else if (!has_work) {
    idle_ += now - asked_at_;
  }
  asked_at_ = now;
  return idle_ < options_.stall && now - news_at_ < options_.longest_stall;
}

}  // namespace egocal::tools
