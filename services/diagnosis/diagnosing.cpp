// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/diagnosing.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <utility>

#include "diagnosis/judgement.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/check.hpp"
#include "egocal/bus/odometry.hpp"
#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "program/stream_counts.hpp"

namespace egocal::services {

namespace {

using namespace std::chrono_literals;

/// Processor time of this process since its start [us].
std::int64_t processor_us() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

}  // namespace

Diagnosing::Diagnosing(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig,
                       std::unique_ptr<SavedMemory> saved, const DiagnosingOptions& options)
    : loop_(loop), heartbeat_(heartbeat), rig_(rig), options_(options), saved_(std::move(saved)) {
  for (const bus::Sensor& sensor : rig.sensors)
    sensors_.push_back({sensor, Stream(bus::stream_options(rig)), 0});
  for (const bus::PairConfig& pair : rig.pairs)
    pairs_.push_back(std::make_unique<DiagnosedPair>(loop, heartbeat, pair, bus::unscaled_side(rig, pair),
                                                     options.sample));
  if (saved_) {
    if (saved_->restore([this](Memory memory) { restore(std::move(memory)); })) {
      heartbeat_.counter("restored") = 1;
    } else if (!saved_->refused().empty()) {
      heartbeat_.reject("saved state that does not fit");
    }
    save_mono_us_ = loop_.mono_us() + to_microseconds(options_.save_distance);
    loop_.every(500ms, [this] {
      if (loop_.mono_us() < save_mono_us_) return;
      save();
      report();
    });
  }
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    loop_.subscribe_bytes(
        sensors_[i].config.channel, [this, i](const bus::Arrival& arrival) { take(i, arrival); },
        options_.queue_capacity);
  hear_commands(loop_, heartbeat_, [this](Verb verb, const command_t& command) { obey(verb, command); });
  heartbeat_.before_publish([this] { count(); });
  loop_.every(100ms, [this] { look(); });
  loop_.every(1s, [this] {
    repeat();
    report();
  });
  report();
}

void Diagnosing::take(std::size_t index, const bus::Arrival& arrival) {
  Sensor& sensor = sensors_[index];
  ++sensor.in;
  const bus::ReceivedOdometry odometry = bus::decode_odometry(sensor.config, arrival.bytes);
  if (!odometry.decoded) return loop_.count_undecodable(arrival.channel);
  if (!odometry.pose) return heartbeat_.reject(odometry.pose.reason);
  for (const NumberedPose& sample : sensor.stream.push({*odometry.pose.value, odometry.seq, 0, false}))
    for (const auto& pair : pairs_)
      for (const Side side : {Side::a, Side::b}) {
        if ((side == Side::a ? pair->config.a : pair->config.b) != sensor.config.name) continue;
        if (sample.begins_anew) pair->begin_anew(side);
        pair->take_pose(side, sample.pose, loop_.mono_us());
      }
}

Memory Diagnosing::memory() const {
  Memory memory;
  for (const Sensor& sensor : sensors_) memory.streams.push_back(sensor.stream.state());
  for (const auto& pair : pairs_) memory.pairs.push_back(pair->memory());
  return memory;
}

/// Throws Error if the memory is of another rig, or no drive can have it; nothing is taken over then.
void Diagnosing::restore(Memory memory) {
  if (memory.streams.size() != sensors_.size() || memory.pairs.size() != pairs_.size())
    throw Error("is of another rig");
  std::vector<Stream> streams(sensors_.size(), Stream(bus::stream_options(rig_)));
  std::vector<DriveSample> samples(pairs_.size(), DriveSample(options_.sample));
  std::vector<FollowedClock> clocks(pairs_.size());
  for (std::size_t i = 0; i < streams.size(); ++i) streams[i].restore(std::move(memory.streams[i]));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const PairMemory& known = memory.pairs[i];
    for (const std::int64_t count :
         {known.matched, known.matched_before, known.matched_between, known.missed_us})
      if (!plausible_count(count)) throw Error("holds counts that no drive can have");
    samples[i].restore(std::exchange(memory.pairs[i].sample, {}));
    clocks[i].restore(std::exchange(memory.pairs[i].offsets, {}));
  }
  for (std::size_t i = 0; i < streams.size(); ++i) sensors_[i].stream = std::move(streams[i]);
  for (std::size_t i = 0; i < samples.size(); ++i)
    pairs_[i]->restore(std::move(samples[i]), std::move(clocks[i]), std::move(memory.pairs[i]));
}

/// If the disk refuses the state, the diagnosis continues without it and tries again.
void Diagnosing::save() {
  std::int64_t poses = 0;
  for (const Sensor& sensor : sensors_) poses += sensor.in;
  if (poses == saved_poses_) return;  // nothing new
  const std::int64_t begin_mono_us = loop_.mono_us();
  try {
    // a slow disk costs no message
    loop_.receive_while([this, now = memory()] { saved_->save(now); });
    saved_poses_ = poses;
    save_error_.clear();
  } catch (const Error& error) {
    if (save_error_.empty()) std::fprintf(stderr, "egocal-diagnosis: %s\n", error.what());
    save_error_ = error.what();
  }
  const std::int64_t now = loop_.mono_us();
  const double took = static_cast<double>(now - begin_mono_us);
  save_mono_us_ =
      now + std::llround(std::max(second_us * options_.save_distance, took / options_.save_share));
}

Diagnosing::~Diagnosing() {
  if (!saved_ || std::uncaught_exceptions() > 0) return;
  try {
    save();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "egocal-diagnosis: %s\n", error.what());
  }
}

void Diagnosing::take_problems() {
  for (const auto& pair : pairs_)
    if (const std::string refused = pair->take_problem(loop_.mono_us()); !refused.empty())
      heartbeat_.reject(refused);
}

void Diagnosing::look() {
  take_problems();
  const bool early = loop_.mono_us() < not_before_mono_us_;
  for (std::size_t n = 0; n < pairs_.size(); ++n) {
    const std::size_t i = (turn_ + n) % pairs_.size();
    DiagnosedPair& pair = *pairs_[i];
    const bool hurried = early && !hurried_ && pair.left_what_was_judged(options_);
    if (!hurried && !pair.to_be_judged(loop_.mono_us(), early, options_)) continue;
    turn_ = i + 1;
    hurried_ = hurried;
    const std::int64_t began = loop_.mono_us(), began_processor_us = processor_us();
    heartbeat_.announce_silence(options_.longest_silence);
    judge(pair);
    heartbeat_.publish();  // it is over: who is silent from now on is gone
    // processor time, as a busy machine spends most of the elapsed time elsewhere; a simulation has its own
    // clock
    const auto took =
        static_cast<double>(std::min(loop_.mono_us() - began, processor_us() - began_processor_us));
    not_before_mono_us_ =
        began + std::llround(std::max(took / options_.share, second_us * options_.least_distance));
    return;  // messages have their turn
  }
}

void Diagnosing::judge(DiagnosedPair& pair) {
  EGOCAL_CHECK(pair.newest.has_value(), "a problem is there when it is judged");
  const std::optional<double> scale = pair.scale_in_force();
  if (!scale) return;
  pair.judged_seq = pair.newest->message.seq;
  pair.judged_until_us = pair.common_end_us();
  try {
    Judgement judgement;
    loop_.receive_while([&] { judgement = services::judge(pair, *scale, rig_, options_); });
    judgement.verdict.sender = heartbeat_.identity().name;
    loop_.publish(bus::verdict_channel(pair.config.a, pair.config.b), judgement.verdict);
    ++heartbeat_.counter("out");
    pair.verdict = std::move(judgement.verdict);
    pair.judged = std::move(judgement.judged);
    pair.error.clear();
    if (judgement.mount_moved && pair.config.on_move == bus::OnMove::restart) restart_after_move(pair);
  } catch (const std::exception& error) {
    heartbeat_.reject("diagnosis failed");
    pair.error = pair.config.a + " -> " + pair.config.b + ": " + error.what();
  }
  report();
}

/// The motions before and after a move have no common answer, so the next session starts without those
/// before. Once a session.
void Diagnosing::restart_after_move(DiagnosedPair& pair) {
  const std::int64_t session = pair.newest->message.session;
  if (std::exchange(pair.known.restarted_session, session) == session) return;
  command_t command{};
  command.utime = loop_.wall_us();
  command.to = "*";
  command.verb = "reset";
  command.sensor_a = pair.config.a;
  command.sensor_b = pair.config.b;
  command.session = session;
  loop_.publish(bus::command_channel, command);
  ++heartbeat_.counter("restarts after a move");
}

/// Sends the verdicts again, for listeners that came late.
void Diagnosing::repeat() {
  for (const auto& pair : pairs_)
    if (pair->verdict) loop_.publish(bus::verdict_channel(pair->config.a, pair->config.b), *pair->verdict);
}

void Diagnosing::obey(Verb verb, const command_t& command) {
  // pairing obeys a reset that is sent to all; one that is sent to this process alone would change nothing
  if (verb == Verb::reset && command.to != "*") return heartbeat_.reject(not_understood);
  bool any = false;
  for (const auto& pair : pairs_) {
    const std::int64_t session = pair->newest ? pair->newest->message.session : 0;
    if (!means(command, verb, pair->config.a, pair->config.b, session)) continue;
    any = true;
    // a reset starts a session with the next pose, and the first problem of that session announces it
    if (verb != Verb::reset) pair->paused = verb == Verb::pause;
  }
  if (!any) heartbeat_.reject(not_meant);
  report();
}

void Diagnosing::report() {
  const bool paused =
      std::all_of(pairs_.begin(), pairs_.end(), [](const auto& pair) { return pair->paused; });
  heartbeat_.set_state(paused ? bus::State::paused : bus::State::running);
  heartbeat_.set_error(error());
}

/// What is wrong now, the worst first.
std::string Diagnosing::error() const {
  for (const auto& pair : pairs_)
    if (!pair->error.empty()) return pair->error;
  if (!save_error_.empty()) return save_error_;
  return saved_ ? saved_->refused() : "";
}

void Diagnosing::count() {
  std::int64_t in = 0;
  StreamCounts sum;
  for (const Sensor& sensor : sensors_) {
    in += sensor.in;
    add(sensor.stream.counts(), sum);
  }
  heartbeat_.counter("poses") = in;
  for (const auto& [name, value] : named(sum)) heartbeat_.counter(name) = value;
}

}  // namespace egocal::services
