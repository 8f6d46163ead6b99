// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "egocal/bus/decode.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/pairing/stream.hpp"
#include "pairing/pair_session.hpp"

namespace egocal::services {

/// One change of what has been accumulated. The same inputs in the same order give the same bits, so a
/// snapshot and the inputs after it are enough to continue.
struct Input {
  enum class Kind : std::uint8_t {
    message,       ///< of a channel, as it came
    give_up,       ///< a channel: waits no longer for what is missing
    patient,       ///< all channels: what is missing will be sent again
    impatient,     ///< all channels: what is missing will not be sent again
    new_session,   ///< a pair: the next pose begins one
    pause,         ///< a pair
    resume,        ///< a pair
    nothing_sent,  ///< a channel: its sender has nothing for the first gap
    settled,       ///< a channel: nothing that its sender repeats is still in flight as a first copy
    silent         ///< a pair: no pose of either sensor comes for a while
  };
  Kind kind = Kind::message;
  std::uint16_t index = 0;   ///< of the channel or pair in the rig
  bus::Bytes bytes{};        ///< of a message
  std::int64_t mono_us = 0;  ///< arrival; nothing that is accumulated depends on it
};

/// Messages with one number that were refused because they are damaged. Such a number has no pose.
struct Refusals {
  std::int32_t times = 0;
  std::int32_t apart =
      0;  ///< of these, after another message, so that they are no copies made by the network
  /// Whether the log itself is damaged: the message came damaged twice, or so often that its sender has no
  /// other copy.
  bool in_the_log() const { return apart >= 2 || times >= 3; }
};

struct ChannelState {
  StreamState stream;
  std::int64_t utime = 0;  ///< see complete_until(), while nothing is waited for
  std::int64_t in = 0;
  std::int64_t undecodable = 0;
  std::map<std::int64_t, Refusals> refused;  ///< by number, those that the stream still misses
  std::int64_t refused_last = -1;            ///< number of the last message, where that was refused; -1
  std::int64_t damaged = 0;                  ///< numbers given up because the log holds no pose for them
};

struct AccumulationState {
  std::vector<ChannelState> channels;  ///< as the rig's sensors
  std::vector<PairState> pairs;        ///< as the rig's pairs
  std::map<std::string, std::int64_t> rejected;
};

/// Everything that egocal-pairing knows, without LCM and without a clock.
class Accumulation {
 public:
  explicit Accumulation(const bus::Rig& rig);

  void apply(const Input& input);
  /// The motion pairs that were completed since the last call.
  std::vector<MotionOut> take_motions() { return std::exchange(motions_, {}); }

  AccumulationState state() const;
  void restore(AccumulationState state);
  /// To be called after an interruption: senders will repeat what was not acknowledged.
  void settle();

  const std::vector<PairSession>& pairs() const { return pairs_; }
  std::vector<PairSession>& pairs() { return pairs_; }
  std::size_t channels() const { return channels_.size(); }
  const bus::Sensor& sensor(std::size_t channel) const { return channels_[channel].sensor; }
  const Stream& stream(std::size_t channel) const { return channels_[channel].stream; }
  /// Time of the newest message before which nothing is missing [us], for acknowledgements. After a message
  /// without a place in the stream (a repetition, or one that is damaged in the log) it is the time of that
  /// message (bus::utime_in()), which needs no repetition. A message that was refused once may have been
  /// damaged by the network, so its repetition is awaited.
  std::int64_t complete_until(std::size_t channel) const;
  void count(std::map<std::string, std::int64_t>& counters) const;

 private:
  struct Channel {
    bus::Sensor sensor;
    Stream stream;
    ChannelState state;  // without the stream's
  };
  void take(Channel& channel, const Input& input);
  static void note_refusal(Channel& channel, std::int64_t number, std::int64_t refused_before);
  static std::size_t awaited_again(const Channel& channel);
  void go_on_behind_damage(Channel& channel);
  void hand_on(Channel& channel, const std::vector<NumberedPose>& samples);

  std::vector<Channel> channels_;
  std::vector<PairSession> pairs_;
  std::map<std::string, std::int64_t> rejected_;
  std::vector<MotionOut> motions_;
};

}  // namespace egocal::services
