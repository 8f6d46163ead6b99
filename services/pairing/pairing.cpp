// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/pairing.hpp"

#include <algorithm>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/glue.hpp"

namespace egocal::services {

namespace {

constexpr int acknowledge_every = 16;
constexpr std::size_t max_early_poses = 4096;
/// Messages of one channel that may wait: more than any player has on the way.
constexpr int queue_capacity = 4096;
constexpr std::int64_t silence_us = 500'000;

}  // namespace

PairSession::PairSession(bus::Loop& loop, const bus::Rig& rig, const bus::PairConfig& config)
    : loop_(loop),
      config_(config),
      options_(bus::drive_options(rig, config)),
      motion_channel_(bus::motion_channel(config.a, config.b)),
      problem_channel_(bus::problem_channel(config.a, config.b)),
      host_(bus::host_name()),
      drive_(options_) {}

void PairSession::begin(std::int64_t time_us) {
  // session numbers only grow, so that the newest problem is known by it
  session_ = std::max(time_us, last_session_ + 1);
  last_session_ = session_;
  drive_ = Drive(options_);
  seq_ = 0;
  early_.clear();
  fresh_ = false;
}

void PairSession::reset() {
  session_ = -1;
  restarted_by_.reset();
}

void PairSession::timeline_restarts(Side side) {
  const bool second_of_both = session_ >= 0 && restarted_by_ && *restarted_by_ != side &&
                              drive_.counts().synchronised == 0 && early_.size() < max_early_poses;
  if (!second_of_both) {
    session_ = -1;
    restarted_by_ = side;
    return;
  }
  // the other stream began anew shortly before: same session, without what this one still sent of the old
  // timeline
  drive_ = Drive(options_);
  std::erase_if(early_, [side](const EarlyPose& early) { return early.side == side; });
  for (const EarlyPose& early : early_) drive_.push(early.side, early.pose);
  restarted_by_.reset();
}

void PairSession::push(Side side, const Sample& sample) {
  if (sample.begins_anew) timeline_restarts(side);
  if (paused_) return;
  if (session_ < 0) begin(sample.pose.time_us);
  received_mono_us_ = sample.mono_us;
  accumulate(side, sample.pose);
}

void PairSession::accumulate(Side side, const StampedPose& pose) {
  if (restarted_by_) {
    if (drive_.counts().synchronised > 0) {
      restarted_by_.reset();
      early_ = {};
    } else if (early_.size() < max_early_poses) {
      early_.push_back({side, pose});
    }
  }
  for (const MotionPair& pair : drive_.push(side, pose)) {
    motion_pair_t message = bus::to_message(pair);
    message.session = session_;
    message.seq = ++seq_;
    message.stride = drive_.choice().stride;
    loop_.publish(motion_channel_, message);
    fresh_ = true;
  }
}

void PairSession::publish(bool repeat) {
  if (session_ < 0 || seq_ == 0 || !(fresh_ || repeat)) return;
  problem_t message = bus::to_message(drive_.problem());
  message.utime = drive_.newest_us().value_or(session_);
  message.session = session_;
  message.seq = seq_;
  message.sensor_a = config_.a;
  message.sensor_b = config_.b;
  message.stride = drive_.choice().stride;
  message.choice = drive_.choice().reason;
  if (config_.truth) {
    message.has_truth = 1;
    bus::set_pose(to_dual_quaternion(*config_.truth), message.truth_pos, message.truth_quat);
  }
  message.time_offset = options_.time_offset;
  const DriveCounts& counts = drive_.counts();
  message.matched = static_cast<std::int64_t>(counts.matched);
  for (const std::uint64_t rejected : counts.rejected)
    message.rejected += static_cast<std::int64_t>(rejected);
  message.host = host_;
  message.received_mono_us = fresh_ ? received_mono_us_ : 0;
  loop_.publish(problem_channel_, message);
  ++sent_;
  fresh_ = false;
}

void PairSession::count(std::map<std::string, std::int64_t>& counters) const {
  const DriveCounts& counts = drive_.counts();
  counters["matched"] += static_cast<std::int64_t>(counts.matched);
  counters["out"] += sent_;
  for (std::size_t i = 0; i < counts.rejected.size(); ++i)
    if (counts.rejected[i] > 0)
      counters["rejected: " + std::string(name(static_cast<Rejection>(i)))] +=
          static_cast<std::int64_t>(counts.rejected[i]);
}

Pairing::Pairing(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig)
    : loop_(loop), heartbeat_(heartbeat) {
  for (const bus::Sensor& sensor : rig.sensors) {
    channels_.push_back(std::make_unique<Channel>(sensor, rig.reorder_window));
    Channel* channel = channels_.back().get();
    loop_.subscribe_bytes(
        sensor.channel, [this, channel](const bus::Arrival& arrival) { take(*channel, arrival); },
        queue_capacity);
  }
  for (const bus::PairConfig& pair : rig.pairs)
    pairs_.push_back(std::make_unique<PairSession>(loop, rig, pair));
  hear_commands(loop_, heartbeat_, [this](Verb verb, const command_t& command) { obey(verb, command); });
  heartbeat_.before_publish([this] { acknowledge(); });
  loop_.after_batch([this](bool caught_up) { after_batch(caught_up); });
  loop_.every(std::chrono::seconds(1), [this] { every_second(); });
  heartbeat_.set_state("running");
}

void Pairing::take(Channel& channel, const bus::Arrival& arrival) {
  ++channel.count;
  ++unacknowledged_;
  channel.heard_mono_us = arrival.mono_us;
  ++heartbeat_.counter("in");
  Sample sample;
  sample.mono_us = arrival.mono_us;
  bool decoded = false;
  bus::Checked<StampedPose> pose;
  if (channel.sensor.type == bus::OdometryType::pose) {
    bot_core::pose_t message{};
    decoded = bus::decode(arrival.bytes, message);
    if (decoded) pose = bus::to_stamped_pose(message);
  } else {
    odometry_t message{};
    decoded = bus::decode(arrival.bytes, message);
    if (decoded) pose = bus::to_stamped_pose(message);
    sample.seq = message.seq;
  }
  if (!decoded) {
    loop_.count_undecodable(channel.sensor.channel);
  } else if (!pose) {
    heartbeat_.reject(pose.reason);
  } else {
    sample.pose = *pose.value;
    channel.utime = sample.pose.time_us;
    route(channel, channel.stream.push(sample));
  }
  if (unacknowledged_ >= acknowledge_every && leads()) heartbeat_.publish();
}

void Pairing::route(const Channel& channel, const std::vector<Sample>& samples) {
  for (const Sample& sample : samples)
    for (const auto& pair : pairs_) {
      if (pair->config().a == channel.sensor.name) pair->push(Side::a, sample);
      if (pair->config().b == channel.sensor.name) pair->push(Side::b, sample);
    }
}

void Pairing::after_batch(bool caught_up) {
  if (!leads()) return;
  for (const auto& pair : pairs_) pair->publish(false);
  // somebody may be waiting for it: a player that keeps in step
  if (caught_up && unacknowledged_ > 0 && heartbeat_.alive("player")) heartbeat_.publish();
}

void Pairing::every_second() {
  const std::int64_t now = bus::mono_us();
  for (const auto& channel : channels_)
    if (channel->stream.waiting() && now - channel->heard_mono_us > silence_us)
      route(*channel, channel->stream.flush());
  const std::optional<bus::Peer> elder = heartbeat_.elder_namesake();
  waits_for_elder_ = elder.has_value();
  heartbeat_.set_state(elder ? "waiting" : paused_ ? "paused" : "running");
  heartbeat_.set_error(elder ? "an older process has this name and goes on: pid " +
                                   std::to_string(elder->pid) + " on " + elder->host
                             : "");
  if (leads())
    for (const auto& pair : pairs_) pair->publish(true);
}

void Pairing::obey(Verb verb, const command_t& command) {
  bool any = false;
  for (const auto& pair : pairs_) {
    if (!means(command, pair->config().a, pair->config().b)) continue;
    if (verb == Verb::reset && command.session != 0 && command.session != pair->session()) continue;
    any = true;
    if (verb == Verb::reset)
      pair->reset();
    else
      pair->pause(verb == Verb::pause);
  }
  if (!any) {
    heartbeat_.reject("command for another session or pair");
    return;
  }
  ++heartbeat_.counter("commands");
  if (verb != Verb::reset)
    paused_ = std::all_of(pairs_.begin(), pairs_.end(), [](const auto& pair) { return pair->paused(); });
  heartbeat_.set_state(paused_ ? "paused" : "running");
}

void Pairing::acknowledge() {
  std::map<std::string, std::int64_t> counters;
  for (const auto& pair : pairs_) pair->count(counters);
  StreamCounts sum;
  for (const auto& channel : channels_) {
    const StreamCounts& counts = channel->stream.counts();
    sum.lost += counts.lost;
    sum.duplicate += counts.duplicate;
    sum.out_of_order += counts.out_of_order;
    sum.jump += counts.jump;
  }
  counters["lost"] = sum.lost;
  counters["rejected: duplicate"] = sum.duplicate;
  counters["rejected: too late"] = sum.out_of_order;
  counters["rejected: time or number jumps"] = sum.jump;
  for (const auto& [name, value] : counters) heartbeat_.counter(name) = value;

  std::vector<acknowledgement_t>& acknowledgements = heartbeat_.acknowledgements();
  acknowledgements.clear();
  if (!leads()) return;
  for (const auto& channel : channels_) {
    acknowledgement_t& entry = acknowledgements.emplace_back();
    entry.channel = channel->sensor.channel;
    entry.utime = channel->utime;
    entry.count = channel->count;
  }
  unacknowledged_ = 0;
}

}  // namespace egocal::services
