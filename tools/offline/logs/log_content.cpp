// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/logs/log_content.hpp"

#include <fmt/format.h>

#include "egocal/bus/decode.hpp"
#include "egocal/in_words.hpp"
#include "offline/reading/lcm_pose.hpp"
#include "progress.hpp"

namespace egocal::tools {

LogContent content_of_log(const std::string& file) {
  bus::LogReader log(file);
  LogContent content;
  content.size = log.size();
  Progress progress("reading");
  while (const auto event = log.next()) {
    const bool shown = content.channels.size() < most_channels || content.channels.contains(event->channel);
    if (!shown) content.more_channels = true;
    LogChannel& channel = shown ? content.channels[event->channel] : content.others;
    if (channel.events++ == 0) {
      channel.first_us = event->time_us;
      const std::string known = decode_lcm_pose(event->data).type;  // the ROS-shaped types as well
      channel.type = known.empty() ? bus::type_name(event->data) : known;
    }
    channel.last_us = event->time_us;
    channel.bytes += event->data.size();
    progress(static_cast<double>(log.position()) / static_cast<double>(log.size()));
  }
  content.damage = log.damage();
  return content;
}

RepairedLog repair_log(const std::string& file, const std::string& out) {
  bus::LogReader log(file);
  bus::LogWriter repaired(out);
  Progress progress("writing");
  RepairedLog result;
  while (const auto event = log.next()) {
    repaired.write(event->time_us, event->channel, event->data);
    ++result.events;
    progress(static_cast<double>(log.position()) / static_cast<double>(log.size()));
  }
  repaired.close();
  result.damage = log.damage();
  return result;
}

std::string damage_text(const bus::LogDamage& damage) {
  if (!damage.any()) return "no damage";
  std::string text;
  if (damage.regions > 0)
    text = fmt::format("{}, {} and at least {} lost", counted(damage.regions, "damaged region"),
                       counted(damage.bytes, "byte"), counted(damage.lost_events, "event"));
  if (damage.jumps > 0)
    text += fmt::format(
        "{}the numbers of the events jump at {}{}", text.empty() ? "" : "; ", counted(damage.jumps, "place"),
        damage.regions > 0 ? "" : fmt::format(", {} missing", counted(damage.lost_events, "event")));
  return text + (damage.truncated ? "; cut off at the end" : "");
}

}  // namespace egocal::tools
