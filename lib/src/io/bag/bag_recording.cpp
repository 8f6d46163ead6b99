// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/bag_recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "egocal/io/checked_pose.hpp"
#include "egocal/limits.hpp"

namespace egocal::detail {

namespace {

constexpr std::size_t largest_number_of_streams = 10'000;  // names alone may not fill the memory

bool is_static(const std::string& topic) {
  constexpr std::string_view end = "tf_static";
  return topic.size() >= end.size() && topic.compare(topic.size() - end.size(), end.size(), end) == 0;
}

/// tf1 wrote frames with a leading slash, tf2 without.
std::string_view frame(std::string_view name) {
  return !name.empty() && name.front() == '/' ? name.substr(1) : name;
}

}  // namespace

void BagRecording::read(const std::string& topic, const TakePose& take) {
  streams_.clear();
  topics_.clear();
  transforms_.clear();
  losses_ = known_.losses;
  notes_ = known_.notes;
  unstamped_ = 0;
  stamps_.clear();
  frames_.clear();
  integrators_.clear();
  for (const auto& part : parts_) {
    if (read_before_) part->rewind();
    read_part(*part, topic, take);
    const ReadLosses& lost = part->losses();
    losses_.regions += lost.regions;
    losses_.bytes += lost.bytes;
    losses_.truncated = losses_.truncated || lost.truncated;
    losses_.checksum = losses_.checksum || lost.checksum;
  }
  read_before_ = true;
  for (std::size_t i = 0; i < stamps_.size(); ++i) take_undecided(i, take);
  for (std::size_t i = 0; i < frames_.size(); ++i) streams_[i].mixed = frames_[i].mixed();
  for (const auto& [stream, integrator] : integrators_)
    notes_.push_back(streams_[stream].name +
                     ": poses are integrated from the velocities in the frame of the sensor");
  if (unstamped_ > 0)
    notes_.push_back(std::to_string(unstamped_) +
                     " messages have no time stamp in their header: the time of recording was taken");
}

void BagRecording::read_part(MessageReader& part, const std::string& topic, const TakePose& take) {
  std::vector<std::size_t> stream_of_topic;
  const auto announce = [&] {
    for (std::size_t i = stream_of_topic.size(); i < part.topics().size(); ++i)
      stream_of_topic.push_back(stream_of(part.topics()[i]));
  };
  BagMessage message;
  while (part.next(message)) {
    announce();
    const std::size_t stream = stream_of_topic[message.topic];
    ++streams_[stream].messages;
    const BagTopic& from = part.topics()[message.topic];
    if (!is_pose_type(from.type) || !streams_[stream].unknown_encoding.empty()) continue;
    // the static transforms of a chain come on another topic
    const bool wanted = topic.empty() || from.name == topic || is_transforms_type(from.type);
    if (wanted) take_message(part, message, stream, take);
  }
  announce();
}

std::size_t BagRecording::stream_of(const BagTopic& topic) {
  const auto known = topics_.find({topic.name, topic.type});
  if (known != topics_.end()) return known->second;
  const std::size_t index = streams_.size();
  const bool decodable = topic.encoding == "cdr" || topic.encoding == "ros1";
  RecordedStream stream;
  stream.name = stream.topic = topic.name;
  stream.type = topic.type;
  stream.poses = decodable && is_pose_type(topic.type) && !is_transforms_type(topic.type);
  if (!decodable) stream.unknown_encoding = topic.encoding;
  streams_.push_back(std::move(stream));
  topics_[{topic.name, topic.type}] = index;
  return index;
}

std::size_t BagRecording::transform_stream(const BagTopic& topic, const MessagePose& pose) {
  const std::string parent(frame(pose.parent)), child(frame(pose.child));
  const auto key = std::pair(topics_[{topic.name, topic.type}], parent + '\n' + child);
  const auto known = transforms_.find(key);
  if (known != transforms_.end()) return known->second;
  if (streams_.size() >= largest_number_of_streams) return streams_.size();
  RecordedStream stream;
  stream.name = topic.name + ":" + parent + "/" + child;
  stream.type = "geometry_msgs/TransformStamped";
  stream.poses = true;
  stream.topic = topic.name;
  stream.parent = parent;
  stream.child = child;
  stream.fixed = is_static(topic.name);
  streams_.push_back(std::move(stream));
  transforms_[key] = streams_.size() - 1;
  return streams_.size() - 1;
}

void BagRecording::refuse(const std::string& topic, const std::string& reason) {
  if (losses_.refused++ == 0) losses_.first_refused = topic + ": " + reason;
}

/// Whether a first stamp of 0 is a time: the second message was recorded as long after its stamp as the first
/// one, to a second. Of an unstamped message of a drive with wall-clock stamps that is off by years.
bool BagRecording::begins_at_zero(const Usable& first, const Usable& second) {
  constexpr double most_ns = 1e9;  // [ns] a second: queues of messages delay by less
  const auto number = [](std::int64_t ns) { return static_cast<double>(ns); };  // hostile ones would overflow
  return std::abs(number(second.log_time_ns) - number(second.stamp_ns) - number(first.log_time_ns)) <=
         most_ns;
}

/// Takes a pose at the time of its header, or at that of recording where the messages of the stream have
/// none. A simulation that begins at zero has one message that looks unstamped, at its beginning: the second
/// one decides.
void BagRecording::take_usable(const Usable& usable, std::size_t stream, const TakePose& take) {
  using Decision = Stamps::Decision;
  if (stream >= stamps_.size()) stamps_.resize(stream + 1);
  Stamps& stamps = stamps_[stream];
  const bool stamped = usable.stamp_ns != 0;
  if (streams_[stream].fixed)
    return take_at(stamped ? usable.stamp_ns : usable.log_time_ns, usable, stream, take);
  const auto refuse_one = [&](const char* reason) { refuse(streams_[stream].topic, reason); };
  constexpr const char* without = "it has no time stamp, others of the topic do";
  if (stamped && stamps.decision == Decision::unstamped)
    return refuse_one("it has a time stamp, others of the topic do not");
  if (stamped) {
    stamps.decision = Decision::stamped;
    const std::vector<Usable> undecided = std::exchange(stamps.undecided, {});
    if (undecided.size() == 1 && begins_at_zero(undecided.front(), usable))
      take_at(0, undecided.front(), stream, take);
    else
      for (std::size_t i = 0; i < undecided.size(); ++i) refuse_one(without);
    return take_at(usable.stamp_ns, usable, stream, take);
  }
  if (stamps.decision == Decision::stamped) return refuse_one(without);
  stamps.undecided.push_back(usable);
  if (stamps.decision == Decision::open && stamps.undecided.size() < most_undecided) return;
  stamps.decision = Decision::unstamped;
  take_undecided(stream, take);
}

/// The first messages of a stream that has no stamps.
void BagRecording::take_undecided(std::size_t stream, const TakePose& take) {
  for (const Usable& usable : std::exchange(stamps_[stream].undecided, {})) {
    ++unstamped_;
    take_at(usable.log_time_ns, usable, stream, take);
  }
}

void BagRecording::take_at(std::int64_t time_ns, const Usable& usable, std::size_t stream,
                           const TakePose& take) {
  const std::int64_t rest_ns = time_ns % 1000;  // has the sign of the time
  const std::int64_t time_us = time_ns / 1000 + (rest_ns >= 500 ? 1 : 0) - (rest_ns <= -500 ? 1 : 0);
  if (!plausible_relative_time(time_us))
    refuse(streams_[stream].topic, "its time is out of range");
  else if (!usable.velocity)
    take(stream, {time_us, usable.pose});
  else if (const auto integrated = integrators_[stream].add({time_us, usable.linear, usable.angular}))
    take(stream, {time_us, *integrated});
  else
    refuse(streams_[stream].topic, "a velocity that is not finite, or not later than the one before");
}

void BagRecording::take_message(MessageReader& part, const BagMessage& message, std::size_t stream,
                                const TakePose& take) {
  const BagTopic& topic = part.topics()[message.topic];
  const bool transforms = is_transforms_type(topic.type);
  const std::optional<ByteSpan> data = unpacker_.unpacked(topic.encoding, message.data);
  if (!data) return refuse(topic.name, "the message is packed and damaged, or longer than 64 MiB");
  const bool decoded = decode_poses(topic.type, topic.encoding, *data, [&](const MessagePose& pose) {
    const std::size_t target = transforms ? transform_stream(topic, pose) : stream;
    if (target == streams_.size()) return refuse(topic.name, "too many frames");
    if (transforms) {
      ++streams_[target].messages;
    } else {
      if (target >= frames_.size()) frames_.resize(target + 1);
      frames_[target].add(frame(pose.parent), frame(pose.child));
      if (streams_[target].parent.empty()) {
        streams_[target].parent = frame(pose.parent);
        streams_[target].child = frame(pose.child);
      }
    }
    const CheckedPose checked = pose.velocity ? CheckedPose{} : checked_pose(pose.translation, pose.wxyz);
    if (!checked.reason.empty()) return refuse(topic.name, checked.reason);
    Usable usable;
    usable.pose = checked.pose;
    usable.velocity = pose.velocity;
    if (pose.velocity) {
      usable.linear = pose.linear;
      usable.angular = pose.angular;
    }
    usable.stamp_ns = pose.time_ns;
    usable.log_time_ns = message.log_time_ns;
    take_usable(usable, target, take);
  });
  if (!decoded)
    refuse(topic.name,
           "the message is damaged or not a " + topic.type + " in the encoding " + topic.encoding);
}

}  // namespace egocal::detail
