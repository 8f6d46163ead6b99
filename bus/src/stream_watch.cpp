// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/stream_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/odometry.hpp"
#include "egocal/bus/plausible.hpp"

namespace egocal::bus {

namespace {

Refusal* known(std::vector<Refusal>& refusals, const std::string& reason) {
  for (Refusal& refusal : refusals)
    if (refusal.reason == reason) return &refusal;
  return nullptr;
}

/// The first of its kind, to be reported.
std::optional<Refusal> add(HeardStream& stream, std::size_t most_refusals, const std::string& reason,
                           const std::string& cure) {
  if (Refusal* refusal = known(stream.refusals, reason)) {
    ++refusal->count;
    return std::nullopt;
  }
  if (stream.refusals.size() >= most_refusals) return std::nullopt;
  stream.refusals.push_back({reason, cure, 1});
  return stream.refusals.back();
}

/// How fast the times of a stream run, where it is one of the usual mistakes.
const char* wrong_unit(double pace) {
  const auto near = [pace](double factor) { return pace > factor / 1.5 && pace < factor * 1.5; };
  return near(1e3) ? "nanoseconds" : near(1e-3) ? "milliseconds" : near(1e-6) ? "seconds" : nullptr;
}

}  // namespace

StreamWatch::StreamWatch(const std::vector<Sensor>& sensors, const StreamWatchOptions& options)
    : options_(options), counting_(sensors.size()) {
  for (const Sensor& sensor : sensors) sensors_.push_back({sensor, std::nullopt});
}

void StreamWatch::count(HeardStream& stream, Counting& counting, std::int64_t mono_us) const {
  ++stream.messages;
  ++counting.in_window;
  if (stream.messages == 1) counting.window_begin_us = mono_us;
  stream.last_mono_us = mono_us;
  const std::int64_t elapsed = mono_us - counting.window_begin_us;
  if (elapsed < options_.rate_window_us) return;
  // the message that begins a window belongs to the one before
  stream.rate = 1e6 * static_cast<double>(counting.in_window - 1) / static_cast<double>(elapsed);
  counting.window_begin_us = mono_us;
  counting.in_window = 1;
}

std::optional<Refusal> StreamWatch::examine(HeardStream& stream, Counting& counting, const Sensor& sensor,
                                            Bytes bytes, std::int64_t mono_us) {
  const ReceivedOdometry odometry = decode_odometry(sensor, bytes);
  if (!odometry.decoded)
    return add(stream, options_.most_refusals, "not decodable", cure_of("not decodable", sensor.type, bytes));
  if (!odometry.pose)
    return add(stream, options_.most_refusals, odometry.pose.reason,
               cure_of(odometry.pose.reason, sensor.type, bytes));
  const std::int64_t time = odometry.pose.value->time_us;
  counting.at_same_time = time == counting.last_time_us ? counting.at_same_time + 1 : 0;
  counting.last_time_us = time;
  if (counting.at_same_time >= options_.most_at_same_time)
    return add(stream, options_.most_refusals, "the same time again",
               "the time does not advance: " + std::to_string(time) +
                   " us: fill utime with the time of the measurement.");
  if (counting.first_mono_us == 0 || time < counting.first_time_us) {
    counting.first_mono_us = mono_us;
    counting.first_time_us = time;
  }
  const std::int64_t elapsed = mono_us - counting.first_mono_us;
  if (elapsed < options_.pace_window_us) return std::nullopt;
  const double pace = static_cast<double>(time - counting.first_time_us) / static_cast<double>(elapsed);
  counting.first_mono_us = mono_us;
  counting.first_time_us = time;
  const char* const unit = wrong_unit(pace);
  if (!unit) return std::nullopt;
  char text[200];
  std::snprintf(text, sizeof text, "its time runs %.2g times as fast as the clock: %s? Send microseconds.",
                pace, unit);
  return add(stream, options_.most_refusals, "unit of time", text);
}

std::optional<Refusal> StreamWatch::hear(const std::string& channel, Bytes bytes, std::int64_t mono_us) {
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    SensorStream& stream = sensors_[i];
    if (stream.sensor.channel != channel) continue;
    if (!stream.heard) stream.heard.emplace().channel = channel;
    count(*stream.heard, counting_[i], mono_us);
    stream.heard->type = type_name(bytes);
    return examine(*stream.heard, counting_[i], stream.sensor, bytes, mono_us);
  }
  if (channel.starts_with("EGOCAL_")) return std::nullopt;
  const auto entry = others_.find(channel);
  if (entry == others_.end() && others_.size() >= options_.most_others) return std::nullopt;
  HeardStream& stream = others_[channel];
  stream.channel = channel;
  stream.type = type_name(bytes);
  stream.is_odometry = is_a<odometry_t>(bytes) || is_a<bot_core::pose_t>(bytes);
  count(stream, others_counting_[channel], mono_us);
  return std::nullopt;
}

bool StreamWatch::misses_any(std::int64_t mono_us) const {
  return sensors_.empty() || std::any_of(sensors_.begin(), sensors_.end(), [&](const SensorStream& stream) {
           return !stream.heard || mono_us - stream.heard->last_mono_us > options_.silent_us;
         });
}

}  // namespace egocal::bus
