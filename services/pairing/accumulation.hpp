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

/// Whatever changes what has been accumulated. The same inputs in the same order give the same bits: a
/// snapshot and the inputs since then are enough to continue from.
struct Input {
  enum class Kind : std::uint8_t {
    message,       ///< of a channel, as it came
    give_up,       ///< a channel: waits no longer for what is missing
    patient,       ///< all channels: what is missing will be sent again
    impatient,     ///< all channels: it will not
    new_session,   ///< a pair: the next pose begins one
    pause,         ///< a pair
    resume,        ///< a pair
    nothing_sent,  ///< a channel: its sender has nothing for the first gap
    settled        ///< a channel: what its sender goes over again is all that it has sent so far
  };
  Kind kind = Kind::message;
  std::uint16_t index = 0;   ///< of the channel or pair in the rig
  bus::Bytes bytes{};        ///< of a message
  std::int64_t mono_us = 0;  ///< arrival; nothing that is accumulated depends on it
};

/// Messages that came with one number and were refused, as damaged: their pose is none.
struct Refusals {
  std::int32_t times = 0;
  std::int32_t apart = 0;  ///< of these, behind another message: no copies that the network made
  /// Twice as it was sent, or so often that its sender has nothing else: what is damaged is the log.
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
  /// After an interruption: senders will go back to what they have not been acknowledged.
  void settle();

  const std::vector<PairSession>& pairs() const { return pairs_; }
  std::vector<PairSession>& pairs() { return pairs_; }
  std::size_t channels() const { return channels_.size(); }
  const bus::Sensor& sensor(std::size_t channel) const { return channels_[channel].sensor; }
  const Stream& stream(std::size_t channel) const { return channels_[channel].stream; }
  /// Time of the newest message before which nothing is missing [us]; for acknowledgements. After a message
  /// that has no place in the stream (a second time, damaged in the log) it is that one's bus::utime_in(): it
  /// is done with. What was refused once may have been damaged on its way, and is waited for.
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
