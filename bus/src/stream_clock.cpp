// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/stream_clock.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "egocal/microseconds.hpp"

namespace egocal::bus {

namespace {

/// The wrong unit that explains this pace of the stamps; null: none of the usual ones.
const char* wrong_unit(double pace) {
  const auto near = [pace](double factor) { return pace > factor / 1.5 && pace < factor * 1.5; };
  return near(1e3) ? "nanoseconds" : near(1e-3) ? "milliseconds" : near(1e-6) ? "seconds" : nullptr;
}

/// By how much more the time of the stream has advanced than ours [us].
std::int64_t gain_us(const Stamp& from, const Stamp& to) {
  return (to.time_us - from.time_us) - (to.mono_us - from.mono_us);
}

/// Whether two stamps with the same time are of the same message.
bool same_message(const Stamp& one, const Stamp& other) {
  return one.seq >= 0 ? one.seq == other.seq : one.position == other.position;
}

std::string jump_in_words(std::int64_t gain_us) {
  const double seconds = to_seconds(std::abs(gain_us));
  char text[200];
  std::snprintf(text, sizeof text,
                "its time %s by %.*f s: was the clock of the sender set? Set it before the sensor sends.",
                gain_us < 0 ? "went back" : "jumped ahead", seconds < 100 ? 1 : 0, seconds);
  return text;
}

}  // namespace

bool StreamClock::known(const Stamp& stamp) const {
  return std::any_of(remembered_.begin(), remembered_.end(), [&](const Stamp& other) {
    return other.time_us == stamp.time_us && same_message(other, stamp);
  });
}

void StreamClock::remember(const Stamp& stamp) {
  if (remembered_.size() < options_.most_remembered)
    remembered_.push_back(stamp);
  else
    remembered_[remembered_next_++ % remembered_.size()] = stamp;
}

/// Whether the time of the stream goes back, or ahead of the clock by more than largest_jump_us.
bool StreamClock::leaps(const Stamp& from, const Stamp& to) const {
  return to.time_us < from.time_us || gain_us(from, to) > options_.largest_jump_us;
}

/// Whether the time of the stream ran like the clock, for long enough.
bool StreamClock::steady() const {
  const double elapsed = static_cast<double>(newest_->mono_us - first_->mono_us);
  return elapsed >= static_cast<double>(options_.steady_us) &&
         std::abs(static_cast<double>(gain_us(*first_, *newest_))) <= options_.steady_part * elapsed;
}

/// Judges a message with the time of the one before. Copies made by the network come one at a time.
std::optional<ClockFault> StreamClock::same_time(const Stamp& stamp) {
  ++at_same_time_;
  const bool copy = same_message(*before_, stamp);
  if (!copy) ++same_time_in_all_;
  if (at_same_time_ >= options_.most_at_same_time)
    return ClockFault{"the same time again", "the time does not advance: " + std::to_string(stamp.time_us) +
                                                 " us: fill utime with the time of the measurement."};
  if (copy || same_time_in_all_ < options_.most_at_same_time) return std::nullopt;
  return ClockFault{"the same time again",
                    "several messages have one time, such as " + std::to_string(stamp.time_us) +
                        " us: fill utime with the time of each measurement, to the microsecond."};
}

std::optional<ClockFault> StreamClock::jump(const Stamp& stamp) {
  if (!leaps(*newest_, stamp)) {
    apart_.clear();
    newest_ = stamp;
    return std::nullopt;
  }
  if (!apart_.empty() && leaps(apart_.back(), stamp)) apart_.clear();
  apart_.push_back(stamp);
  if (apart_.size() < options_.confirmations) return std::nullopt;
  const Stamp begin = apart_.front();
  const std::int64_t gain = gain_us(*newest_, begin);
  const bool begins_anew = begin.seq >= 0 && begin.seq <= newest_->seq;  // another start of the sender
  // the newest may have come late
  const bool ahead = steady() && gain_us(*first_, begin) > options_.largest_jump_us;
  const bool named = !begins_anew && (begin.time_us < newest_->time_us || ahead);
  apart_.clear();
  first_ = newest_ = stamp;
  pace_.reset();
  if (!named) return std::nullopt;
  return ClockFault{"clock jumps", jump_in_words(gain)};
}

/// Judges the unit of the stamps. A single leap is a jump and says nothing about the unit; in nanoseconds
/// every step is a leap.
std::optional<ClockFault> StreamClock::unit(const Stamp& before, const Stamp& stamp) {
  if (!pace_ || stamp.time_us < pace_->begin.time_us) {
    pace_ = Pace{stamp};
    return std::nullopt;
  }
  ++pace_->steps;
  if (leaps(before, stamp)) ++pace_->leaps;
  const std::int64_t elapsed = stamp.mono_us - pace_->begin.mono_us;
  if (elapsed < options_.pace_window_us) return std::nullopt;
  const Pace over = *std::exchange(pace_, Pace{stamp});
  if (over.leaps > 0 && 2 * over.leaps <= over.steps) return std::nullopt;
  const double pace = static_cast<double>(stamp.time_us - over.begin.time_us) / static_cast<double>(elapsed);
  const char* const unit = wrong_unit(pace);
  if (!unit) return std::nullopt;
  char text[200];
  std::snprintf(text, sizeof text, "its time runs %.2g times as fast as the clock: %s? Send microseconds.",
                pace, unit);
  return ClockFault{"unit of time", text};
}

std::optional<ClockFault> StreamClock::hear(const Stamp& stamp) {
  if (!before_) {
    before_ = first_ = newest_ = stamp;
    pace_ = Pace{stamp};
    remember(stamp);
    return std::nullopt;
  }
  std::optional<ClockFault> fault;
  if (stamp.time_us == before_->time_us) {
    fault = same_time(stamp);
  } else {
    at_same_time_ = 0;
    if (known(stamp)) return std::nullopt;  // sent again
    fault = jump(stamp);
  }
  remember(stamp);
  const std::optional<ClockFault> of_unit = unit(*before_, stamp);
  before_ = stamp;
  return fault ? fault : of_unit;
}

}  // namespace egocal::bus
