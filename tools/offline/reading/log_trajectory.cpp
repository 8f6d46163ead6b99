// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/log_trajectory.hpp"

#include <fmt/format.h>

#include <map>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/error.hpp"
#include "offline/reading/channel_list.hpp"
#include "offline/reading/lcm_pose.hpp"
#include "offline/reading/log_damage.hpp"

namespace egocal::tools {

namespace {

/// A clock that is set back by less continues as the same session; the poses that it repeats are not used
/// [us].
constexpr std::int64_t session_jump_us = 10'000'000;

class Collector {
 public:
  void take(const LcmPose& message) {
    ++messages_;
    if (!message.pose)
      ++refused_[message.pose.reason];
    else
      add(stream_.push({*message.pose.value, message.seq, 0, false}));
  }

  LogTrajectory finished(const std::string& file, const std::string& channel) {
    add(stream_.flush());
    const std::string text = not_used(file, channel);  // counts the poses
    return {std::move(poses_), text, {}, {}};
  }
  bool empty() const { return messages_ == 0; }

 private:
  void add(const std::vector<NumberedPose>& in_order) {
    for (const NumberedPose& next : in_order) {
      const std::int64_t time_us = next.pose.time_us;
      other_session_ = other_session_ || (!poses_.empty() && next.begins_anew &&
                                          time_us < poses_.back().time_us - session_jump_us);
      if (other_session_)
        ++later_sessions_;
      else if (!poses_.empty() && time_us <= poses_.back().time_us)
        ++late_;
      else
        poses_.push_back(next.pose);
    }
  }

  std::string not_used(const std::string& file, const std::string& channel) const {
    const StreamCounts& counts = stream_.counts();
    std::string text;
    const auto say = [&text](auto count, const std::string& what) {
      if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    };
    for (const auto& [reason, count] : refused_) say(count, "refused (" + reason + ")");
    say(counts.jump, "with a damaged time or number");
    say(counts.duplicate, "duplicate");
    say(late_ + static_cast<std::size_t>(counts.out_of_order), "too late");
    say(counts.lost, "missing by their numbers");
    say(later_sessions_, "of a later session");
    if (text.empty()) return {};
    return fmt::format("{}: {}: {} of {} messages are used; {}", file, channel, poses_.size(), messages_,
                       text);
  }

  Stream stream_{StreamOptions{.look_ahead = true}};
  Trajectory poses_;
  std::map<std::string, std::size_t> refused_;
  std::size_t messages_ = 0, late_ = 0, later_sessions_ = 0;
  bool other_session_ = false;
};

}  // namespace

LogTrajectory read_log_trajectory(const std::string& file, const std::string& channel) {
  bus::LogReader log(file);
  Collector collector;
  TwistIntegrator integrator;
  ChannelTimes times;
  ChannelList channels;
  while (const std::optional<bus::LogEvent> event = log.next()) {
    if (event->channel == channel)
      collector.take(
          with_integrated_pose(times.checked(decode_lcm_pose(event->data, event->time_us)), integrator));
    else
      channels.add(event->channel);
  }
  const std::string damage = damage_in_words(log.damage());
  if (collector.empty())
    throw error_at(
        file, 0, channel,
        "no such channel in the log; there are: " + channels.text() + (damage.empty() ? "" : "; " + damage));
  LogTrajectory result = collector.finished(file, channel);
  if (result.poses.empty()) throw error_at(file, 0, channel, "no pose in this channel: " + result.not_used);
  if (const std::string note = times.note(); !note.empty()) result.times = channel + ": " + note;
  if (!damage.empty()) result.damage = file + ": " + damage;
  return result;
}

}  // namespace egocal::tools
