// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "player/tape.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "egocal/error.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::services {

namespace {

constexpr double largest_time_us = 9e18;  // fits an int64; times that are damaged may be anything

std::regex compiled(const std::string& expression) {
  try {
    return std::regex(expression);
  } catch (const std::regex_error& error) {
    throw Error("--channel: '" + expression + "' is not a regular expression: " + error.what());
  }
}

}  // namespace

Tape::Tape(const std::string& file, const TapeOptions& options)
    : log_(file, options.times), options_(options) {
  if (!options.channel.empty()) channel_ = compiled(options.channel);
  if (const std::optional<bus::LogEvent> first = log_.next()) begin_us_ = first->time_us;
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
  skipped_ = 0;
  from_ = from;
}

double Tape::part() const {
  return static_cast<double>(log_.position()) / static_cast<double>(std::max<std::uint64_t>(1, log_.size()));
}

bool Tape::wanted(const std::string& channel) {
  if (channel_) return std::regex_match(channel, *channel_);
  const bool ours = channel.rfind("EGOCAL_", 0) == 0;
  skipped_ += ours;
  return !ours;
}

std::optional<bus::LogEvent> Tape::next() {
  while (std::optional<bus::LogEvent> event = log_.next()) {
    // as doubles: the difference of damaged times may not fit
    const double into_us = static_cast<double>(event->time_us) - static_cast<double>(begin_us_);
    if (options_.end && into_us > std::round(second_us * *options_.end)) return std::nullopt;
    // where the clock was set back, events are older than the first one
    if ((from_ <= 0 || into_us >= std::round(second_us * from_)) && wanted(event->channel)) return event;
  }
  return std::nullopt;
}

}  // namespace egocal::services
