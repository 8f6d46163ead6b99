// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Which problems egocal-pairing sends, and when.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "egocal/bus/check.hpp"
#include "pairing/pairing.hpp"

namespace egocal::services {

void Pairing::publish_new_problems() {
  std::optional<std::int64_t> later_us;  // when the next one is due
  const auto due_later = [&](std::int64_t due) { later_us = std::min(due, later_us.value_or(due)); };
  std::optional<std::size_t> early;  // of those that need a choice the one that has waited the longest
  int waiting = 0;
  const std::int64_t now = loop_.mono_us();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (!accumulation_.pairs()[i].fresh()) continue;
    const std::int64_t due = published_mono_us_[i] + options_.problem_distance_us;
    if (accumulation_.pairs()[i].costs_a_choice()) {
      ++waiting;
      if (!early || published_mono_us_[i] < published_mono_us_[*early]) early = i;
    } else if (now >= due) {
      publish_problem(i);
    } else {
      due_later(due);
    }
  }
  if (early && now >= early_choice_mono_us_ + options_.early_choice_distance_us) {
    publish_problem(*early);
    early_choice_mono_us_ = loop_.mono_us();
    --waiting;
  }
  if (waiting > 0) due_later(early_choice_mono_us_ + options_.early_choice_distance_us);
  if (later_us && !publish_timer_)
    publish_timer_ =
        loop_.after(std::chrono::microseconds(std::max<std::int64_t>(0, *later_us - now)), [this] {
          publish_timer_.reset();
          save();
          if (leads()) publish_new_problems();
        });
}

/// A problem may be sent only after its inputs are on the disk, or after the status has reported that the
/// disk fails.
bool Pairing::saved_or_known_not_to_be() const {
  return !saved_ || saved_->complete() || !save_error_.empty();
}

void Pairing::publish_problem(std::size_t pair) {
  EGOCAL_CHECK(leads(), "only the pairing process that leads sends problems");
  EGOCAL_CHECK(saved_or_known_not_to_be(), "a problem is saved before it is sent");
  PairSession& session = accumulation_.pairs()[pair];
  if (const std::optional<scale_problem_t> scale = session.scale_message())
    loop_.publish(channels_[pair].scale_problem, *scale);
  std::optional<problem_t> message = session.message();
  if (!message) return;
  message->host = loop_.host();
  loop_.publish(channels_[pair].problem, *message);
  published_mono_us_[pair] = loop_.mono_us();
  ++sent_;
}

void Pairing::publish_all_problems() {
  save();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    // publish_new_problems() has each of these in its turn
    if (const PairSession& pair = accumulation_.pairs()[i]; pair.fresh() && pair.costs_a_choice()) continue;
    publish_problem(i);
  }
}

void Pairing::publish_motions() {
  for (const MotionOut& motion : accumulation_.take_motions())
    loop_.publish(channels_[motion.pair].motion, motion.message);
}

}  // namespace egocal::services
