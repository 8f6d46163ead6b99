// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Messages about one pair of sensors. Each has a channel of its own and also holds the names of the pair.
#pragma once

#include <string>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/loop.hpp"

namespace egocal::bus {

/// The channel of a message: that of the pair that it names.
inline std::string channel_of(const problem_t& message) {
  return problem_channel(message.sensor_a, message.sensor_b);
}
inline std::string channel_of(const calibration_t& message) {
  return calibration_channel(message.sensor_a, message.sensor_b);
}
inline std::string channel_of(const verdict_t& message) {
  return verdict_channel(message.sensor_a, message.sensor_b);
}
inline std::string channel_of(const scale_problem_t& message) {
  return scale_problem_channel(message.sensor_a, message.sensor_b);
}
inline std::string channel_of(const scale_t& message) {
  return scale_channel(message.sensor_a, message.sensor_b);
}

/// Subscribes to all messages about a pair: hear(message, arrival) takes each of the types above. A message
/// with other names than those of the pair is damaged, or sent by another program. It must not count for
/// another pair, so it is counted in Loop::undecodable().
template <class Hear>
void subscribe_pair(Loop& loop, const std::string& a, const std::string& b, const Hear& hear) {
  const auto subscribe = [&]<class Message>(const Message&, const std::string& channel) {
    loop.subscribe<Message>(channel, [&loop, hear, a, b](const Message& message, const Arrival& arrival) {
      if (message.sensor_a == a && message.sensor_b == b)
        hear(message, arrival);
      else
        loop.count_undecodable(arrival.channel);
    });
  };
  subscribe(problem_t{}, problem_channel(a, b));
  subscribe(calibration_t{}, calibration_channel(a, b));
  subscribe(verdict_t{}, verdict_channel(a, b));
  subscribe(scale_problem_t{}, scale_problem_channel(a, b));
  subscribe(scale_t{}, scale_channel(a, b));
}

}  // namespace egocal::bus
