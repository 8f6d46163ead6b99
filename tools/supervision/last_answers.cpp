// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/last_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "egocal/in_words.hpp"

namespace egocal::tools {

using std::chrono::duration_cast;
using std::chrono::milliseconds;

bool LastAnswers::wait_on(int missing, const Work& work, Time now) {
  if (missing == 0) return false;
  if (!begun()) {
    begun_at_ = asked_at_ = now;
    processor_ = work.processor;
  }
  const Time::duration passed = std::min<Time::duration>(now - asked_at_, options_.longest_step);
  // one that was started again begins at 0
  const auto used = std::max<Time::duration>(work.processor - processor_, Time::duration{0});
  waited_processor_ += used;
  const bool rises_count = now - begun_at_ < options_.longest_stall;  // or two senders would hold us for ever
  if (!begun() || missing < *missing_ || (missing > *missing_ && rises_count)) {
    missing_ = missing;
    idle_ = busy_ = {};
  } else if (work.computes) {
    busy_ += used;
  } else if (work.held) {
    busy_ += passed;
  } else {
    idle_ += passed;
  }
  asked_at_ = now;
  processor_ = work.processor;
  return idle_ < options_.stall && busy_ < options_.longest_stall;
}

std::optional<Waited> LastAnswers::to_report() {
  const Time::duration time = asked_at_ - begun_at_;
  if (!begun() || time < report_after_) return std::nullopt;
  report_after_ = 2 * time;
  return Waited{duration_cast<milliseconds>(time), duration_cast<milliseconds>(waited_processor_)};
}

std::string in_words(int missing, const Waited& waited) {
  return fmt::format(
      "still waiting for the last answer or verdict of {}: in the {:.0f} s since the log's end the processes "
      "have computed for {:.1f} s, {:.0f} % of a core (Ctrl-C ends it)",
      counted(static_cast<std::uint64_t>(missing), "pair"), 1e-3 * static_cast<double>(waited.time.count()),
      1e-3 * static_cast<double>(waited.processor.count()),
      100 * static_cast<double>(waited.processor.count()) / static_cast<double>(waited.time.count()));
}

}  // namespace egocal::tools
