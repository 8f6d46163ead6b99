// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/lcm_recording.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <map>

#include "egocal/bus/log_file.hpp"
#include "offline/reading/lcm_pose.hpp"

namespace egocal::tools {

bool is_lcm_log(const std::string& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return false;  // a pipe can be read only once
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 4> first{};
  return stream.read(first.data(), first.size()) && std::string(first.data(), 4) == "\xed\xa1\xda\x01";
}

std::size_t LcmRecording::stream_of(const std::string& channel) {
  constexpr std::size_t most_streams = 10'000;  // a damaged log may hold any number of names
  const auto known = channels_.find(channel);
  if (known != channels_.end()) return known->second;
  if (streams_.size() >= most_streams) return streams_.size() - 1;
  channels_[channel] = streams_.size();
  RecordedStream stream;
  stream.name = stream.topic = channel;
  streams_.push_back(stream);
  return streams_.size() - 1;
}

void LcmRecording::read(const std::string& topic, const TakePose& take) {
  streams_.clear();
  channels_.clear();
  losses_ = {};
  notes_.clear();
  bus::LogReader log(file_);
  std::map<std::size_t, TwistIntegrator> integrators;  // by stream
  std::map<std::size_t, ChannelTimes> times;
  while (const auto event = log.next()) {
    const std::size_t index = stream_of(event->channel);
    ++streams_[index].messages;
    if (!topic.empty() && event->channel != topic) {
      // its first message tells what it holds, for people who look for the right name
      if (streams_[index].messages > 1) continue;
      streams_[index].type = decode_lcm_pose(event->data).type;
      streams_[index].poses = !streams_[index].type.empty();
      continue;
    }
    const LcmPose message = with_integrated_pose(
        times[index].checked(decode_lcm_pose(event->data, event->time_us)), integrators[index]);
    if (message.type.empty()) continue;
    streams_[index].type = message.type;
    streams_[index].poses = true;
    if (message.pose)
      take(index, *message.pose.value);
    else if (losses_.refused++ == 0)
      losses_.first_refused = event->channel + ": " + message.pose.reason;
  }
  for (const auto& [stream, time] : times)
    if (const std::string note = time.note(); !note.empty())
      notes_.push_back(streams_[stream].name + ": " + note);
  losses_.regions = log.damage().regions + log.damage().jumps;
  losses_.bytes = log.damage().bytes;
  losses_.truncated = log.damage().truncated;
}

}  // namespace egocal::tools
