// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "player/tape.hpp"

#include <algorithm>
#include <cmath>

#include "egocal/error.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::services {

namespace {

constexpr double largest_time_us = 9e18;  // fits an int64; times that are damaged may be anything

/// Whether a - b > by, without overflow: damaged times may have any value.
bool later(std::int64_t a, std::int64_t b, std::int64_t by) {
  return a > b &&
         static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b) > static_cast<std::uint64_t>(by);
}

std::regex compiled(const std::string& expression) {
  try {
    return std::regex(expression);
  } catch (const std::regex_error& error) {
    throw Error("--channel: '" + expression + "' is not a regular expression: " + error.what());
  }
}

}  // namespace

Tape::Tape(const std::string& file, const TapeOptions& options) : log_(file), options_(options) {
  if (!options.channel.empty()) channel_ = compiled(options.channel);
  look_ahead();
  repair_time();
  begin_us_ = ahead_.front().time_us;
  rewind(options.start);
  if (!next()) {
    throw error_at(file, 0, "",
                   "nothing to play: no event of the channels and times asked for" +
                       std::string(skipped_ > 0 ? "; its EGOCAL_ channels are played with --channel" : ""));
  }
  rewind(options.start);
}

void Tape::rewind(double from) {
  // skips the events in between, so a seek in a log of 10 GB takes no longer than in a small one
  const double target_us = static_cast<double>(begin_us_) + second_us * from;
  if (from > 0 && std::abs(target_us) < largest_time_us)
    log_.seek(std::llround(target_us));
  else
    log_.rewind();
  ahead_.clear();
  last_us_.reset();
  damaged_times_ = skipped_ = 0;
  from_ = from;
}

double Tape::part() const {
  return static_cast<double>(log_.position()) / static_cast<double>(std::max<std::uint64_t>(1, log_.size()));
}

void Tape::look_ahead() {
  while (ahead_.size() < 3) {
    std::optional<bus::LogEvent> event = log_.next();
    if (!event) return;
    ahead_.push_back(std::move(*event));
  }
}

/// That of the next event.
void Tape::repair_time() {
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

bool Tape::wanted(const std::string& channel) {
  if (channel_) return std::regex_match(channel, *channel_);
  const bool ours = channel.rfind("EGOCAL_", 0) == 0;
  skipped_ += ours;
  return !ours;
}

std::optional<bus::LogEvent> Tape::next() {
  while (true) {
    look_ahead();
    if (ahead_.empty()) return std::nullopt;
    repair_time();
    bus::LogEvent event = std::move(ahead_.front());
    ahead_.pop_front();
    last_us_ = event.time_us;
    // as doubles: the difference of damaged times may not fit
    const double into_us = static_cast<double>(event.time_us) - static_cast<double>(begin_us_);
    if (options_.end && into_us > std::round(second_us * *options_.end)) return std::nullopt;
    // where the clock was set back, events are older than the first one
    if ((from_ <= 0 || into_us >= std::round(second_us * from_)) && wanted(event.channel)) return event;
  }
}

}  // namespace egocal::services
