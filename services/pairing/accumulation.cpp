// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/accumulation.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "egocal/bus/odometry.hpp"
#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "program/stream_counts.hpp"

namespace egocal::services {

namespace {

/// Refusals of numbers farther ahead of the stream are not remembered, which bounds the memory. Several times
/// as many as a player has in flight.
constexpr std::int64_t farthest_refused = 256;

/// Whether the refusals in a state that was read from a file are plausible: its counts must not overflow
/// later.
bool plausible_refusals(const ChannelState& state) {
  const auto plausible = [](const auto& entry) {
    return entry.first >= 0 && entry.second.times >= 0 && entry.second.times < INT32_MAX / 2 &&
           entry.second.apart >= 0 && entry.second.apart <= entry.second.times;
  };
  return state.damaged >= 0 && state.damaged <= limits::largest_count &&
         state.refused.size() <= static_cast<std::size_t>(farthest_refused) + 1 &&
         std::all_of(state.refused.begin(), state.refused.end(), plausible);
}

}  // namespace

Accumulation::Accumulation(const bus::Rig& rig) {
  for (const bus::Sensor& sensor : rig.sensors)
    channels_.push_back({sensor, Stream(bus::stream_options(rig)), {}});
  for (std::size_t i = 0; i < rig.pairs.size(); ++i) pairs_.emplace_back(rig, i);
}

void Accumulation::apply(const Input& input) {
  switch (input.kind) {
    case Input::Kind::message:
      take(channels_.at(input.index), input);
      return go_on_behind_damage(channels_.at(input.index));
    case Input::Kind::give_up:
      return hand_on(channels_.at(input.index), channels_.at(input.index).stream.flush());
    case Input::Kind::nothing_sent:
      return hand_on(channels_.at(input.index), channels_.at(input.index).stream.give_up_first_gap());
    case Input::Kind::settled:
      return hand_on(channels_.at(input.index), channels_.at(input.index).stream.end_settling());
    case Input::Kind::patient:
    case Input::Kind::impatient:
      for (Channel& channel : channels_) channel.stream.be_patient(input.kind == Input::Kind::patient);
      return;
    case Input::Kind::new_session:
      return pairs_.at(input.index).reset();
    case Input::Kind::silent:
      return pairs_.at(input.index).release_held(motions_);
    case Input::Kind::pause:
    case Input::Kind::resume:
      return pairs_.at(input.index).pause(input.kind == Input::Kind::pause);
  }
}

void Accumulation::take(Channel& channel, const Input& input) {
  ++channel.state.in;
  channel.state.utime = bus::utime_in(input.bytes);
  const std::int64_t refused_before = std::exchange(channel.state.refused_last, -1);
  const bus::ReceivedOdometry odometry = bus::decode_odometry(channel.sensor, input.bytes);
  if (!odometry.decoded) {
    ++channel.state.undecodable;
  } else if (!odometry.pose) {
    ++rejected_[odometry.pose.reason];
    note_refusal(channel, odometry.seq, refused_before);
  } else {
    hand_on(channel, channel.stream.push({*odometry.pose.value, odometry.seq, input.mono_us, false}));
  }
}

void Accumulation::hand_on(Channel& channel, const std::vector<NumberedPose>& samples) {
  // the numbers begin again
  if (std::any_of(samples.begin(), samples.end(), [](const auto& sample) { return sample.begins_anew; }))
    channel.state.refused.clear();
  // one that fills a gap completes those behind it
  if (!samples.empty()) channel.state.utime = channel.stream.newest_us().value_or(0);
  for (const NumberedPose& sample : samples)
    for (PairSession& pair : pairs_) {
      if (pair.config().a == channel.sensor.name) pair.push(Side::a, sample, motions_);
      if (pair.config().b == channel.sensor.name) pair.push(Side::b, sample, motions_);
    }
}

/// Notes the refusal of a message that the stream misses: its sender can repeat it, if it was the network
/// that damaged it.
void Accumulation::note_refusal(Channel& channel, std::int64_t number, std::int64_t refused_before) {
  const std::int64_t expected = channel.stream.expected();
  if (expected < 0 || number < expected || number - expected > farthest_refused) return;
  channel.state.refused_last = number;
  Refusals& refusals = channel.state.refused[number];
  ++refusals.times;
  if (refused_before != number) ++refusals.apart;
}

/// The number of refused messages that their sender will repeat.
std::size_t Accumulation::awaited_again(const Channel& channel) {
  const auto& refused = channel.state.refused;
  return static_cast<std::size_t>(std::count_if(
      refused.begin(), refused.end(), [](const auto& entry) { return !entry.second.in_the_log(); }));
}

/// Does not wait for numbers that are damaged in the log. If another number is missing in the same gap, that
/// number is awaited first.
void Accumulation::go_on_behind_damage(Channel& channel) {
  auto& refused = channel.state.refused;
  const StreamState& stream = channel.stream.state();
  const auto forget = [&] { refused.erase(refused.begin(), refused.lower_bound(channel.stream.expected())); };
  for (forget(); !refused.empty() && !stream.early.empty(); forget()) {
    const std::int64_t first = channel.stream.expected(), behind = stream.early.begin()->first;
    for (std::int64_t number = first; number < behind; ++number) {
      const auto entry = refused.find(number);
      if (entry == refused.end() || !entry->second.in_the_log()) return;
    }
    channel.state.damaged += behind - first;
    hand_on(channel, channel.stream.give_up_first_gap());
    if (channel.stream.expected() <= first) return;
  }
}

std::int64_t Accumulation::complete_until(std::size_t index) const {
  const Channel& channel = channels_[index];
  if (channel.stream.waiting() || channel.stream.unconfirmed() > 0 || awaited_again(channel) > 0)
    return channel.stream.newest_us().value_or(0);
  return channel.state.utime;
}

void Accumulation::count(std::map<std::string, std::int64_t>& counters) const {
  for (const PairSession& pair : pairs_) pair.count(counters);
  StreamCounts sum;
  std::int64_t given_up = 0, at_the_end = 0;  // damaged in the log
  for (const Channel& channel : channels_) {
    add(channel.stream.counts(), sum);
    counters["in"] += channel.state.in;
    if (channel.state.undecodable > 0)
      counters["rejected: not decodable on " + channel.sensor.channel] = channel.state.undecodable;
    counters["held back: " + channel.sensor.channel] =
        static_cast<std::int64_t>(channel.stream.held_back() + awaited_again(channel));
    given_up += channel.state.damaged;
    for (const auto& [number, refusals] : channel.state.refused)
      if (refusals.in_the_log()) ++at_the_end;
  }
  sum.lost = std::max<std::int64_t>(0, sum.lost - given_up);
  for (const auto& [name, value] : named(sum)) counters[name] = value;
  if (given_up + at_the_end > 0) counters["lost: damaged in the log"] = given_up + at_the_end;
  for (const auto& [reason, value] : rejected_) counters["rejected: " + reason] = value;
}

AccumulationState Accumulation::state() const {
  AccumulationState state;
  for (const Channel& channel : channels_) {
    state.channels.push_back(channel.state);
    state.channels.back().stream = channel.stream.state();
  }
  for (const PairSession& pair : pairs_) state.pairs.push_back(pair.state());
  state.rejected = rejected_;
  return state;
}

void Accumulation::restore(AccumulationState state) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (!plausible_refusals(state.channels.at(i))) throw Error("holds counts that no channel can have");
    channels_[i].stream.restore(std::move(state.channels.at(i).stream));
    channels_[i].state = std::move(state.channels[i]);
    channels_[i].state.stream = {};
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) pairs_[i].restore(std::move(state.pairs.at(i)));
  rejected_ = std::move(state.rejected);
}

void Accumulation::settle() {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    channels_[i].state.utime = complete_until(i);
    channels_[i].stream.be_patient(true);
    channels_[i].stream.settle();
  }
}

}  // namespace egocal::services
