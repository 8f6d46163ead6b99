// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What arrives on the sensors' channels, for people who start a rig for the first time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "egocal/bus/bytes.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/bus/stream_clock.hpp"

namespace egocal::bus {

/// Messages of one kind that cannot be used.
struct Refusal {
  std::string reason;  ///< as in the counters: "time out of range"
  std::string cure;    ///< with the value that was seen: "times 1.49e18 us: nanoseconds? Send microseconds."
  std::int64_t count = 0;
};

/// One channel as it is received.
struct HeardStream {
  std::string channel;
  std::string type;  ///< "egocal.odometry_t", "bot_core.pose_t", another type of ours, or "unknown type"
  bool is_odometry = false;
  std::int64_t messages = 0;
  double rate = 0;  ///< over the last two to four seconds [1/s]
  std::int64_t last_mono_us = 0;
  std::int64_t stamp_us = 0, stamp_mono_us = 0;  ///< of the last pose: its time, and its arrival; 0: none yet
  std::vector<Refusal> refusals;                 ///< in the order in which they were first seen
};

/// One sensor of the rig.
struct SensorStream {
  Sensor sensor;
  std::optional<HeardStream> heard;  ///< empty: nothing yet
};

/// What is to be said of a stream, one line for people.
struct StreamLine {
  enum class Severity { good, warning, bad } severity = Severity::good;
  std::string text;
};

/// Study: tests/bus/test_stream_watch.cpp.
struct StreamWatchOptions {
  std::int64_t rate_window_us = 2'000'000;  ///< the rate is counted over this: two messages of 1 Hz [us]
  StreamClockOptions clock;
  std::int64_t silent_us = 2'000'000;  ///< a stream without messages for this long is silent [us]
  /// Stamps of two streams that are farther apart overlap nowhere [us]: several times what a network delays.
  std::int64_t apart_us = 2'000'000;
  std::size_t most_others = 64;    ///< channels that no sensor names: a bound on memory
  std::size_t most_refusals = 16;  ///< kinds, of one channel: a bound on memory
};

/// Watches the channels of a rig, and others that carry odometry where a sensor is missed. Bounded in memory
/// whatever arrives. Times are those of the loop's clock [us].
class StreamWatch {
 public:
  explicit StreamWatch(const std::vector<Sensor>& sensors, const StreamWatchOptions& options = {});

  /// Takes a message of any channel. Returns a refusal that is the first of its kind on a sensor's channel.
  std::optional<Refusal> hear(const std::string& channel, Bytes bytes, std::int64_t mono_us);

  const std::vector<SensorStream>& sensors() const { return sensors_; }
  /// Channels that no sensor of the rig names, by name. At most most_others.
  const std::map<std::string, HeardStream>& others() const { return others_; }
  /// Whether some sensor has sent nothing for silent_us: the other channels are then looked at.
  bool misses_any(std::int64_t mono_us) const;

  const StreamWatchOptions& options() const { return options_; }

 private:
  struct Counting {
    std::int64_t window_begin_us = 0, in_window = 0;
  };
  void count(HeardStream& stream, Counting& counting, std::int64_t mono_us) const;
  std::optional<Refusal> examine(HeardStream& stream, StreamClock& clock, const Sensor& sensor, Bytes bytes,
                                 std::int64_t mono_us) const;

  StreamWatchOptions options_;
  std::vector<SensorStream> sensors_;
  std::vector<Counting> counting_;   ///< of the sensors
  std::vector<StreamClock> clocks_;  ///< likewise
  std::map<std::string, HeardStream> others_;
  std::map<std::string, Counting> others_counting_;
};

/// What to do about messages that were refused for a reason of convert.hpp, with the message's own values.
std::string cure_of(const std::string& reason, OdometryType type, Bytes bytes);
/// What to do about poses and motions that pairing rejects, by the name in its counters; empty: nothing is
/// known.
std::string cure_of_rejection(const std::string& reason);

/// A line for each sensor, and one for each kind of refusal below it. why_silent: a reason for which streams
/// may be silent ("the player is paused"): no fault of a sensor, unless it was never received and others
/// were. Empty: none.
std::vector<StreamLine> stream_lines(const StreamWatch& watch, std::int64_t mono_us,
                                     const std::string& why_silent = {});

/// Why two sensors, by name, have no motion in common for a while, one of which sends: one is silent, or
/// their stamps do not overlap. Empty: both are silent, or nothing is known of them. rejected: what pairing
/// rejects, where that is known.
std::string why_no_motion(const StreamWatch& watch, const std::string& a, const std::string& b,
                          std::int64_t mono_us, const std::string& rejected = {});

}  // namespace egocal::bus
