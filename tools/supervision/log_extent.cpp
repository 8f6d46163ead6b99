// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/log_extent.hpp"

#include <algorithm>
#include <optional>

#include "egocal/bus/odometry.hpp"
#include "egocal/limits.hpp"
#include "egocal/pairing/stream.hpp"

namespace egocal::tools {

namespace {

constexpr std::int64_t tenth_us = 100'000;  // a fiftieth of the shortest hole that is reported

/// The poses of a sensor as pairing counts them: in order, each time once, without damaged times.
class Counting {
 public:
  void push(const StampedPose& pose, LogExtent::Stream& counted) {
    count(stream_.push({pose, -1, 0, false}), counted);
  }
  void finish(LogExtent::Stream& counted) { count(stream_.flush(), counted); }

 private:
  void count(const std::vector<NumberedPose>& in_order, LogExtent::Stream& counted) {
    for (const NumberedPose& next : in_order) {
      if (next.begins_anew) {
        if (newest_us_) counted.earlier_us += *newest_us_ - counted.first_us;
        counted.first_us = next.pose.time_us;
        counted.poses.clear();
      }
      if (next.begins_anew || !newest_us_ || next.pose.time_us > *newest_us_) {
        newest_us_ = next.pose.time_us;
        counted.poses.add(*newest_us_);
      }
    }
  }

  Stream stream_{StreamOptions{.look_ahead = true}};
  std::optional<std::int64_t> newest_us_;
};

/// When the messages of a log were recorded, by sensor.
class Silences {
 public:
  /// Takes the time at which a message was recorded. A damaged time is none.
  void add(const std::string& name, std::int64_t time_us, LogExtent::Stream& stream) {
    if (!plausible_relative_time(time_us)) return;
    if (waiting_ && !is_ahead_of(time_us)) take(*waiting_);
    waiting_ = {&name, time_us, &stream};
  }
  void finish(LogExtent& extent) {
    if (waiting_) take(*waiting_);
    for (auto& [name, last_us] : last_us_) keep_longest(last_us, end_us_, extent.sensors.at(name));
  }

 private:
  struct Message {
    const std::string* sensor;
    std::int64_t time_us;
    LogExtent::Stream* stream;
  };

  /// Whether the message that waits was recorded after the ones before and after it: messages are recorded
  /// one after the other, so its time is damaged.
  bool is_ahead_of(std::int64_t next_us) const {
    return waiting_->time_us - next_us > ahead_us && (!begin_us_ || waiting_->time_us - end_us_ > ahead_us);
  }

  void take(const Message& message) {
    const auto& [sensor, time_us, stream] = message;
    if (begin_us_ && time_us - end_us_ > longest_us) return;
    if (!begin_us_) begin_us_ = end_us_ = time_us;
    end_us_ = std::max(end_us_, time_us);
    ++stream->messages;
    keep_longest(last_us_.try_emplace(*sensor, *begin_us_).first->second, time_us, *stream);
  }

  void keep_longest(std::int64_t& last_us, std::int64_t time_us, LogExtent::Stream& stream) const {
    if (time_us - last_us > stream.silent_until_us - stream.silent_from_us) {
      stream.silent_from_us = last_us - *begin_us_;
      stream.silent_until_us = time_us - *begin_us_;
    }
    last_us = std::max(last_us, time_us);
  }

  /// Longest step between messages of a log, whatever sensor they are of: a longer one is a damaged time.
  static constexpr std::int64_t longest_us = std::int64_t{24} * 3600 * 1'000'000;
  /// A damaged time is ahead of its neighbours by more than this. A clock that is set back in mid-drive is
  /// not, as the message before the step follows others, and a second less is no silence that is reported.
  static constexpr std::int64_t ahead_us = 1'000'000;
  std::optional<Message> waiting_;  ///< until the next one is known
  std::optional<std::int64_t> begin_us_;
  std::int64_t end_us_ = 0;
  std::map<std::string, std::int64_t> last_us_;  ///< by sensor
};

}  // namespace

void PoseCounts::add(std::int64_t time_us) {
  constexpr std::int64_t gap_us = 2'000'000;  // between poses of slow sensors a second passes
  if (const std::int64_t step_us = time_us - last_us_; step_us < gap_us) {
    ++steps_;
    stepped_us_ += step_us;
  }
  last_us_ = time_us;
  const std::int64_t number = time_us / tenth_us;
  if (tenths_.empty() || tenths_.back().number != number)
    tenths_.push_back({number, tenths_.empty() ? 0 : tenths_.back().poses});
  ++tenths_.back().poses;
}

std::int64_t PoseCounts::until(std::int64_t time_us) const {
  const auto after =
      std::upper_bound(tenths_.begin(), tenths_.end(), time_us / tenth_us,
                       [](std::int64_t number, const Tenth& tenth) { return number < tenth.number; });
  return after == tenths_.begin() ? 0 : std::prev(after)->poses;
}

std::int64_t PoseCounts::between(std::int64_t from_us, std::int64_t to_us) const {
  return std::max<std::int64_t>(0, until(to_us) - until(from_us));
}

LogExtent log_extent(bus::LogReader& log, const bus::Rig& rig) {
  LogExtent extent;
  std::map<std::string, Counting> countings;
  Silences silences;
  log.rewind();
  while (const std::optional<bus::LogEvent> event = log.next())
    for (const bus::Sensor& sensor : rig.sensors) {
      if (sensor.channel != event->channel) continue;
      const bus::ReceivedOdometry odometry = bus::decode_odometry(sensor, event->data);
      if (!odometry.decoded || !odometry.pose) {
        ++extent.unreadable[sensor.name];
        continue;
      }
      const StampedPose& pose = *odometry.pose.value;
      LogExtent::Stream& stream =
          extent.sensors
              .try_emplace(sensor.name, LogExtent::Stream{pose.time_us, pose.time_us, {}, 0, pose.time_us})
              .first->second;
      stream.last_us = pose.time_us;
      silences.add(sensor.name, event->time_us, stream);
      countings[sensor.name].push(pose, stream);
    }
  for (auto& [name, counting] : countings) counting.finish(extent.sensors.at(name));
  silences.finish(extent);
  extent.damage = log.damage();
  return extent;
}

}  // namespace egocal::tools
