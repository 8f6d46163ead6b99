// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "egocal/bus/plausible.hpp"
#include "egocal/bus/stream_watch.hpp"

namespace egocal::bus {

namespace {

using Severity = StreamLine::Severity;

constexpr std::size_t most_named = 3;  ///< channels that were received instead

std::string rate_text(double rate) {
  char text[40];
  std::snprintf(text, sizeof text, rate < 9.95 ? "%.1f Hz" : "%.0f Hz", rate);
  return text;
}

std::string expected_type(const Sensor& sensor) {
  return sensor.type == OdometryType::pose ? "bot_core.pose_t" : "egocal.odometry_t";
}

std::string described(const HeardStream& stream) {
  return printable(stream.channel, 63) + " (" + stream.type +
         (stream.rate > 0 ? ", " + rate_text(stream.rate) : "") + ")";
}

/// Other channels that were heard, those with odometry first: they show how a misspelt name is spelt.
std::string heard_instead(const StreamWatch& watch, std::int64_t mono_us) {
  std::vector<const HeardStream*> streams;
  for (const auto& [channel, stream] : watch.others())
    if (mono_us - stream.last_mono_us <= watch.options().silent_us) streams.push_back(&stream);
  std::stable_sort(streams.begin(), streams.end(), [](const HeardStream* x, const HeardStream* y) {
    return x->is_odometry && !y->is_odometry;
  });
  std::string text;
  for (std::size_t i = 0; i < streams.size() && i < most_named; ++i)
    text += (i ? ", " : "") + described(*streams[i]);
  if (streams.size() > most_named) text += " and " + std::to_string(streams.size() - most_named) + " more";
  return text;
}

/// Nothing was ever received, as when a monitor is started during a pause. If other streams were received, a
/// silent channel has the wrong name.
bool nothing_ever_came(const StreamWatch& watch) {
  return watch.others().empty() && std::none_of(watch.sensors().begin(), watch.sensors().end(),
                                                [](const SensorStream& s) { return s.heard.has_value(); });
}

StreamLine line_of(const SensorStream& stream, const StreamWatch& watch, std::int64_t mono_us,
                   const std::string& why_silent) {
  const Sensor& sensor = stream.sensor;
  const std::string begin = sensor.name + ": " + printable(sensor.channel, 63) + ", ";
  const bool silent = !stream.heard || mono_us - stream.heard->last_mono_us > watch.options().silent_us;
  if (silent) {
    const std::string instead = heard_instead(watch, mono_us);
    const std::string text =
        stream.heard
            ? "silent for " + std::to_string((mono_us - stream.heard->last_mono_us) / 1'000'000) + " s"
            : std::string("nothing received");
    if (!why_silent.empty() && (stream.heard || nothing_ever_came(watch)))
      return {Severity::good, begin + text + ": " + why_silent};
    return {Severity::bad, begin + text + "; " +
                               (instead.empty() ? "no other channel carries anything (expected " +
                                                      expected_type(sensor) + ")"
                                                : "received instead: " + instead)};
  }
  std::int64_t refused = 0;
  for (const Refusal& refusal : stream.heard->refusals) refused += refusal.count;
  std::string text =
      begin + stream.heard->type + ", " +
      (stream.heard->rate > 0 ? rate_text(stream.heard->rate) : std::string("rate not known yet")) + ", " +
      std::to_string(stream.heard->messages) + " messages";
  if (refused > 0) text += ", " + std::to_string(refused) + " of them with faults";
  return {refused > 0 ? Severity::warning : Severity::good, text};
}

}  // namespace

std::vector<StreamLine> stream_lines(const StreamWatch& watch, std::int64_t mono_us,
                                     const std::string& why_silent) {
  std::vector<StreamLine> lines;
  for (const SensorStream& stream : watch.sensors()) {
    lines.push_back(line_of(stream, watch, mono_us, why_silent));
    if (!stream.heard) continue;
    for (const Refusal& refusal : stream.heard->refusals)
      lines.push_back({Severity::warning,
                       "  " + std::to_string(refusal.count) + " x " + refusal.reason + ": " + refusal.cure});
  }
  if (watch.sensors().empty())
    for (const auto& [channel, stream] : watch.others())
      lines.push_back({stream.is_odometry ? Severity::good : Severity::warning,
                       described(stream) + ", " + std::to_string(stream.messages) + " messages"});
  return lines;
}

std::string why_no_motion(const StreamWatch& watch, const std::string& a, const std::string& b,
                          std::int64_t mono_us, const std::string& rejected) {
  const auto sends = [&](const std::string& name) -> const HeardStream* {
    for (const SensorStream& stream : watch.sensors())
      if (stream.sensor.name == name && stream.heard &&
          mono_us - stream.heard->last_mono_us <= watch.options().silent_us)
        return &*stream.heard;
    return nullptr;
  };
  const HeardStream* const of_a = sends(a);
  const HeardStream* const of_b = sends(b);
  if (!of_a && !of_b) return {};
  if (!of_a || !of_b) return (of_a ? b : a) + " sends nothing";
  if (of_a->stamp_us == 0 || of_b->stamp_us == 0) return (of_a->stamp_us == 0 ? a : b) + " sends no poses";
  // as doubles: stamps may be anything
  const auto ahead_us = [](const HeardStream& stream) {
    return static_cast<double>(stream.stamp_us) - static_cast<double>(stream.stamp_mono_us);
  };
  const double apart_us = ahead_us(*of_a) - ahead_us(*of_b);
  if (std::abs(apart_us) <= static_cast<double>(watch.options().apart_us))
    return "pairing rejects the poses" + (rejected.empty() ? ", see its counters" : ": " + rejected);
  char seconds[64];
  std::snprintf(seconds, sizeof seconds, "%.1f s", 1e-6 * std::abs(apart_us));
  return "the stamps of the two streams do not overlap: those of " + (apart_us > 0 ? a : b) + " are " +
         seconds + " ahead. Set the clocks that stamp them alike";
}

}  // namespace egocal::bus
