// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/accumulation.hpp"

#include "egocal/bus/odometry.hpp"

namespace egocal::services {

Accumulation::Accumulation(const bus::Rig& rig) {
  StreamOptions options;
  options.reorder_window = rig.reorder_window;
  for (const bus::Sensor& sensor : rig.sensors) channels_.push_back({sensor, Stream(options), {}});
  for (std::size_t i = 0; i < rig.pairs.size(); ++i) pairs_.emplace_back(rig, i);
}

void Accumulation::apply(const Input& input) {
  switch (input.kind) {
    case Input::Kind::message:
      return take(channels_.at(input.index), input);
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
    case Input::Kind::pause:
    case Input::Kind::resume:
      return pairs_.at(input.index).pause(input.kind == Input::Kind::pause);
  }
}

void Accumulation::take(Channel& channel, const Input& input) {
  ++channel.state.in;
  channel.state.utime = bus::utime_in(input.bytes);
  const bus::ReceivedOdometry odometry = bus::decode_odometry(channel.sensor, input.bytes);
  if (!odometry.decoded) {
    ++channel.state.undecodable;
  } else if (!odometry.pose) {
    ++rejected_[odometry.pose.reason];
  } else {
    hand_on(channel, channel.stream.push({*odometry.pose.value, odometry.seq, input.mono_us, false}));
  }
}

void Accumulation::hand_on(Channel& channel, const std::vector<NumberedPose>& samples) {
  // one that fills a gap completes those behind it
  if (!samples.empty()) channel.state.utime = channel.stream.newest_us().value_or(0);
  for (const NumberedPose& sample : samples)
    for (PairSession& pair : pairs_) {
      if (pair.config().a == channel.sensor.name) pair.push(Side::a, sample, motions_);
      if (pair.config().b == channel.sensor.name) pair.push(Side::b, sample, motions_);
    }
}

std::int64_t Accumulation::complete_until(std::size_t index) const {
  const Channel& channel = channels_[index];
  if (channel.stream.waiting() || channel.stream.unconfirmed() > 0)
    return channel.stream.newest_us().value_or(0);
  return channel.state.utime;
}

void Accumulation::count(std::map<std::string, std::int64_t>& counters) const {
  for (const PairSession& pair : pairs_) pair.count(counters);
  StreamCounts sum;
  for (const Channel& channel : channels_) {
    const StreamCounts& counts = channel.stream.counts();
    sum.lost += counts.lost;
    sum.duplicate += counts.duplicate;
    sum.out_of_order += counts.out_of_order;
    sum.jump += counts.jump;
    counters["in"] += channel.state.in;
    if (channel.state.undecodable > 0)
      counters["rejected: not decodable on " + channel.sensor.channel] = channel.state.undecodable;
    counters["held back: " + channel.sensor.channel] = static_cast<std::int64_t>(channel.stream.held_back());
  }
  counters["lost"] = sum.lost;
  counters["rejected: duplicate"] = sum.duplicate;
  counters["rejected: too late"] = sum.out_of_order;
  counters["rejected: time or number jumps"] = sum.jump;
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
