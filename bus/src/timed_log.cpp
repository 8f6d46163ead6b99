// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/timed_log.hpp"

#include <utility>

namespace egocal::bus {

namespace {

/// Whether a - b > by, without overflow: damaged times may have any value.
bool later(std::int64_t a, std::int64_t b, std::int64_t by) {
  return a > b &&
         static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b) > static_cast<std::uint64_t>(by);
}

}  // namespace

TimedLog::TimedLog(const std::string& file, const TimedLogOptions& options) : log_(file), options_(options) {}

void TimedLog::begin() {
  ahead_.clear();
  last_us_.reset();
  damaged_times_ = 0;
}

void TimedLog::rewind() {
  log_.rewind();
  begin();
}

void TimedLog::seek(std::int64_t time_us) {
  log_.seek(time_us);
  begin();
}

void TimedLog::look_ahead() {
  while (ahead_.size() < 3) {
    std::optional<LogEvent> event = log_.next();
    if (!event) return;
    ahead_.push_back(std::move(*event));
  }
}

/// Corrects the time of the next event where it fits neither of its neighbours.
void TimedLog::correct_next_time() {
  const std::int64_t time = ahead_[0].time_us;
  std::int64_t corrected = time;
  if (last_us_ && ahead_.size() > 1) {
    const std::int64_t after = ahead_[1].time_us;
    const bool goes_on = !later(*last_us_, after, options_.disorder_us);  // a clock set back stays back
    if (goes_on && (later(time, after, options_.disorder_us) || later(*last_us_, time, options_.disorder_us)))
      corrected = *last_us_;
  } else if (last_us_) {
    if (later(*last_us_, time, options_.disorder_us) || later(time, *last_us_, options_.longest_gap_us))
      corrected = *last_us_;
  } else if (ahead_.size() > 2) {
    const std::int64_t second = ahead_[1].time_us, third = ahead_[2].time_us;
    const bool in_order = !later(second, third, options_.disorder_us);
    if (in_order &&
        (later(time, second, options_.disorder_us) || later(second, time, options_.longest_gap_us)))
      corrected = second;
  }
  if (corrected == time) return;
  ahead_[0].time_us = corrected;
  ++damaged_times_;
}

std::optional<LogEvent> TimedLog::next() {
  look_ahead();
  if (ahead_.empty()) return std::nullopt;
  correct_next_time();
  LogEvent event = std::move(ahead_.front());
  ahead_.pop_front();
  last_us_ = event.time_us;
  return event;
}

}  // namespace egocal::bus
