// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/stream_watch.hpp"

#include <algorithm>
#include <utility>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/odometry.hpp"
#include "egocal/bus/plausible.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::bus {

namespace {

Refusal* known(std::vector<Refusal>& refusals, const std::string& reason) {
  for (Refusal& refusal : refusals)
    if (refusal.reason == reason) return &refusal;
  return nullptr;
}

/// Counts a refusal. Returns it where it is the first of its kind, to be reported.
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

}  // namespace

StreamWatch::StreamWatch(const std::vector<Sensor>& sensors, const StreamWatchOptions& options)
    : options_(options), counting_(sensors.size()), clocks_(sensors.size(), StreamClock(options.clock)) {
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
  stream.rate = second_us * static_cast<double>(counting.in_window - 1) / static_cast<double>(elapsed);
  counting.window_begin_us = mono_us;
  counting.in_window = 1;
}

std::optional<Refusal> StreamWatch::examine(HeardStream& stream, StreamClock& clock, const Sensor& sensor,
                                            Bytes bytes, std::int64_t mono_us) const {
  const ReceivedOdometry odometry = decode_odometry(sensor, bytes);
  if (!odometry.decoded)
    return add(stream, options_.most_refusals, "not decodable", cure_of("not decodable", sensor.type, bytes));
  if (!odometry.pose)
    return add(stream, options_.most_refusals, odometry.pose.reason,
               cure_of(odometry.pose.reason, sensor.type, bytes));
  const StampedPose& pose = *odometry.pose.value;
  stream.stamp_us = pose.time_us;
  stream.stamp_mono_us = mono_us;
  const Eigen::Vector3d place = to_pose(pose.pose).translation;
  const std::optional<ClockFault> fault =
      clock.hear({pose.time_us, mono_us, odometry.seq, {place.x(), place.y(), place.z()}});
  if (!fault) return std::nullopt;
  return add(stream, options_.most_refusals, fault->reason, fault->cure);
}

std::optional<Refusal> StreamWatch::hear(const std::string& channel, Bytes bytes, std::int64_t mono_us) {
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    SensorStream& stream = sensors_[i];
    if (stream.sensor.channel != channel) continue;
    if (!stream.heard) stream.heard.emplace().channel = channel;
    count(*stream.heard, counting_[i], mono_us);
    stream.heard->type = type_name(bytes);
    return examine(*stream.heard, clocks_[i], stream.sensor, bytes, mono_us);
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
