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

#include "diagnosis/remedies.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/check.hpp"
#include "egocal/bus/odometry.hpp"
#include "egocal/bus/verdict.hpp"
#include "egocal/error.hpp"
#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/scale/scale_statistics.hpp"
#include "egocal/scale/solve_scale.hpp"
#include "program/stream_counts.hpp"

namespace egocal::services {

namespace {

using namespace std::chrono_literals;

/// The number of poses of the slower stream at common times. 0 if the clock of one sensor was set meanwhile.
std::size_t at_common_times(const Trajectory& a, const Trajectory& b, double time_offset) {
  if (a.empty() || b.empty()) return 0;
  const std::int64_t offset = to_microseconds(time_offset);
  const std::int64_t begin = std::max(a.front().time_us, b.front().time_us + offset);
  const std::int64_t end = std::min(a.back().time_us, b.back().time_us + offset);
  const auto between = [](const Trajectory& poses, std::int64_t first, std::int64_t last) {
    return static_cast<std::size_t>(std::count_if(poses.begin(), poses.end(), [&](const StampedPose& pose) {
      return pose.time_us >= first && pose.time_us <= last;
    }));
  };
  return std::min(between(a, begin, end), between(b, begin - offset, end - offset));
}

/// Time until which both streams have poses, on the clock of a; 0: one of them has none.
std::int64_t common_end(const DriveSample& sample, double time_offset) {
  const Trajectory &a = sample.poses(Side::a), &b = sample.poses(Side::b);
  if (a.empty() || b.empty()) return 0;
  return std::min<std::int64_t>(a.back().time_us, b.back().time_us + to_microseconds(time_offset));
}

/// That this thread has had [us].
std::int64_t processor_us() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

}  // namespace

Diagnosing::Diagnosing(bus::Loop& loop, bus::Heartbeat& heartbeat, const bus::Rig& rig,
                       std::unique_ptr<SavedMemory> saved, const DiagnosingOptions& options)
    : loop_(loop), heartbeat_(heartbeat), rig_(rig), options_(options), saved_(std::move(saved)) {
  for (const bus::Sensor& sensor : rig.sensors)
    sensors_.push_back({sensor, Stream(bus::stream_options(rig)), 0});
  for (const bus::PairConfig& pair : rig.pairs)
    pairs_.push_back(
        std::make_unique<Pair>(loop, heartbeat, pair, bus::unscaled_side(rig, pair), options.sample));
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
        if (sample.begins_anew) {
          pair->sample.begin_anew(side);
          if (pair->newest) pair->known.matched_before = pair->newest->message.matched;
          forget_what_was_missed(*pair);
        }
        if (pair->paused) continue;
        note_what_was_missed(*pair, side, sample.pose);
        pair->sample.push(side, sample.pose);
        pair->newest_pose_mono_us = loop_.mono_us();
      }
}

/// At the first pose of a stream after a restart: poses between the saved state and this one are never
/// judged.
void Diagnosing::note_what_was_missed(Pair& pair, Side side, const StampedPose& pose) {
  if (!std::exchange(pair.continues[side == Side::b], false) || pair.sample.poses(side).empty()) return;
  const std::int64_t missed = pose.time_us - pair.sample.poses(side).back().time_us;
  // both streams lack about the same time: it counts once
  if (pair.continues[side != Side::b]) pair.known.missed_us += std::max<std::int64_t>(0, missed);
}

void Diagnosing::forget_what_was_missed(Pair& pair) {
  pair.known.matched_between = pair.known.missed_us = 0;
  pair.continues[0] = pair.continues[1] = false;
}

Memory Diagnosing::memory() const {
  Memory memory;
  for (const Sensor& sensor : sensors_) memory.streams.push_back(sensor.stream.state());
  for (const auto& pair : pairs_) {
    memory.pairs.push_back(pair->known);
    memory.pairs.back().sample = pair->sample.state();
    memory.pairs.back().offsets = pair->clock.offsets();
  }
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
  for (std::size_t i = 0; i < samples.size(); ++i) {
    pairs_[i]->sample = std::move(samples[i]);
    pairs_[i]->clock = std::move(clocks[i]);
    pairs_[i]->known = std::move(memory.pairs[i]);
    pairs_[i]->continues[0] = pairs_[i]->continues[1] = true;
  }
}

/// If the disk refuses the state, the diagnosis continues without it and tries again.
void Diagnosing::save() {
  std::int64_t poses = 0;
  for (const Sensor& sensor : sensors_) poses += sensor.in;
  if (poses == saved_poses_) return;  // nothing new
  const std::int64_t begin_mono_us = loop_.mono_us();
  try {
    saved_->save(memory());
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
  for (const auto& pair : pairs_) {
    scale_problem_t scale{};
    if (pair->unscaled && pair->scales.take(scale))
      if (const std::string refused = pair->scale.take(scale); !refused.empty()) heartbeat_.reject(refused);
    std::optional<ReceivedProblem> received = pair->inbox.take();
    if (!received) continue;
    const problem_t& message = received->message;
    const bool same_session = pair->known.session == message.session;
    if (!same_session || !pair->newest || pair->newest->message.seq != message.seq)
      pair->newest_mono_us = loop_.mono_us();
    if (!same_session) {
      // if times ran backwards, the session number is no time, and the streams have started again
      if (message.session <= message.utime) pair->sample.begin_session(message.session);
      pair->clock.clear();
      pair->judged_seq = -1;
      pair->known.matched_before = message.matched;
      forget_what_was_missed(*pair);
      pair->verdict.reset();
      pair->judged.reset();
      pair->error.clear();
    } else if (!pair->newest) {
      // the first one since the restart
      pair->known.matched_between += std::max<std::int64_t>(0, message.matched - pair->known.matched);
    }
    pair->known.session = message.session;
    pair->known.matched = message.matched;
    pair->sample.set_time_offset(message.time_offset);
    pair->clock.add(message.utime, to_microseconds(message.time_offset));
    pair->newest = std::move(received);
  }
}

bool Diagnosing::idle(const Pair& pair) const {
  return to_seconds(loop_.mono_us() - pair.newest_mono_us) >= options_.idle;
}

/// At full speed many motions precede the first problem that is heard, but none precedes the first pose. If
/// one sensor starts later, its poses come late, but no motions are missed.
Unseen Diagnosing::unseen_of(const Pair& pair, std::size_t poses) {
  const problem_t& message = pair.newest->message;
  std::int64_t begin = message.session;
  for (const Side side : {Side::a, Side::b}) {
    const Trajectory& sample = pair.sample.poses(side);
    const std::int64_t offset = side == Side::b ? to_microseconds(message.time_offset) : 0;
    begin = std::max(begin, sample.empty() ? message.utime : sample.front().time_us + offset);
  }
  const auto part = [](double unseen, double all) {
    return all > 0 ? std::clamp(unseen / all, 0.0, 1.0) : 0;
  };
  const PairMemory& known = pair.known;
  const std::int64_t unseen_us = begin - message.session + known.missed_us;
  return {std::min(part(static_cast<double>(known.matched_before + known.matched_between),
                        static_cast<double>(message.matched)),
                   part(to_seconds(unseen_us), to_seconds(message.utime - message.session))),
          to_seconds(unseen_us), poses, known.missed_us > 0};
}

/// Because of a new problem, or of poses alone. early: without waiting, if nothing more comes.
bool Diagnosing::to_be_judged(const Pair& pair, bool early) const {
  if (!pair.newest) return false;
  if (pair.newest->message.seq != pair.judged_seq) return !early || idle(pair);
  const bool more_poses = to_seconds(common_end(pair.sample, pair.newest->message.time_offset) -
                                     pair.judged_until_us) >= options_.pose_step;
  const bool no_poses_come = to_seconds(loop_.mono_us() - pair.newest_pose_mono_us) >= options_.idle;
  return more_poses && (!early || (idle(pair) && no_poses_come));
}

/// Once for each problem; a solve takes microseconds.
bool Diagnosing::left_what_was_judged(Pair& pair) const {
  if (!pair.judged || !pair.newest) return false;
  const std::int64_t seq = pair.newest->message.seq;
  if (seq == pair.judged_seq || std::exchange(pair.compared_seq, seq) == seq) return false;
  try {
    const Answer answer = solve(pair.newest->problem, Method::dual);
    return deviations_from(*pair.judged, answer.T_a_b) > options_.far_from_judged;
  } catch (const std::exception&) {
    return true;  // judge() reports it
  }
}

void Diagnosing::look() {
  take_problems();
  const bool early = loop_.mono_us() < not_before_mono_us_;
  for (std::size_t n = 0; n < pairs_.size(); ++n) {
    const std::size_t i = (turn_ + n) % pairs_.size();
    Pair& pair = *pairs_[i];
    const bool hurried = early && !hurried_ && left_what_was_judged(pair);
    if (!hurried && !to_be_judged(pair, early)) continue;
    turn_ = i + 1;
    hurried_ = hurried;
    const std::int64_t began = loop_.mono_us(), began_processor_us = processor_us();
    judge(pair);
    // processor time, as a busy machine spends most of the elapsed time elsewhere; a simulation has its own
    // clock
    const auto took =
        static_cast<double>(std::min(loop_.mono_us() - began, processor_us() - began_processor_us));
    not_before_mono_us_ =
        began + std::llround(std::max(took / options_.share, second_us * options_.least_distance));
    return;  // messages have their turn
  }
}

void Diagnosing::judge(Pair& pair) {
  EGOCAL_CHECK(pair.newest.has_value(), "a problem is there when it is judged");
  const problem_t& message = pair.newest->message;
  const Problem& problem = pair.newest->problem;
  // the scale of the problem comes in a separate message
  const std::optional<double> scale =
      pair.unscaled ? pair.scale.in_force(pair.config.a, pair.config.b, message.session) : 1;
  if (!scale) return;
  pair.judged_seq = message.seq;
  pair.judged_until_us = common_end(pair.sample, message.time_offset);
  DiagnosisOptions options;
  options.goal = pair.config.goal;
  options.platform = pair.config.platform;
  options.mount.false_alarms = options_.false_alarms;
  options.mount.shown_before = options_.shown_before;
  PairingOptions pairing = bus::drive_options(rig_, pair.config);
  pairing.time_offset = message.time_offset;
  const auto poses_of = [&](Side side) {
    return pair.unscaled == side ? scaled(pair.sample.poses(side), *scale) : pair.sample.poses(side);
  };
  const Trajectory a = poses_of(Side::a), b = pair.clock.at_newest_offset(poses_of(Side::b));
  const std::size_t poses = at_common_times(a, b, message.time_offset);
  try {
    const Answer answer = solve(problem, Method::dual);
    Answered answered;
    answered.T_a_b = answer.minimum;
    answered.observability = answer.observability;
    answered.problem = problem;
    answered.stride = message.stride;
    answered.seconds = to_seconds(message.utime - message.session);
    if (pair.unscaled)
      if (const ScaleSolution* solution = pair.scale.solution(pair.config.a, pair.config.b, message.session))
        answered.scale_stddev = with_spread_of_scale({}, problem, *solution);
    bus::Judged judged{answer.T_a_b, message.utime, message.utime, 0};
    Diagnosis diagnosis;
    if (poses < options_.unseen.least_poses) {
      diagnosis = diagnose(answered, options);
    } else {
      diagnosis = options_.diagnose(a, b, pairing, answered, options);
      judged = {answer.T_a_b, a.front().time_us, a.back().time_us, static_cast<std::int64_t>(poses)};
    }
    limit_to_what_was_seen(unseen_of(pair, poses), diagnosis, options_.unseen);
    word_remedies(rig_, pair.config, diagnosis.findings);
    verdict_t verdict = bus::to_message(diagnosis, judged);
    verdict.utime = message.utime;
    verdict.session = message.session;
    verdict.seq = message.seq;
    for (const statistics_t& block : message.blocks) verdict.pairs += block.count;
    verdict.sensor_a = pair.config.a;
    verdict.sensor_b = pair.config.b;
    verdict.sender = heartbeat_.identity().name;
    loop_.publish(bus::verdict_channel(verdict.sensor_a, verdict.sensor_b), verdict);
    ++heartbeat_.counter("out");
    pair.verdict = std::move(verdict);
    pair.judged.reset();
    if (diagnosis.verdict < Verdict::doubtful)
      pair.judged = JudgedAnswer{to_pose(answer.T_a_b), answer.observability};
    pair.error.clear();
    if (pair.config.on_move == bus::OnMove::restart) restart_after_move(pair, diagnosis);
  } catch (const std::exception& error) {
    heartbeat_.reject("diagnosis failed");
    pair.error = pair.config.a + " -> " + pair.config.b + ": " + error.what();
  }
  report();
}

/// The motions before and after a move have no common answer, so the next session starts without those
/// before. Once a session.
void Diagnosing::restart_after_move(Pair& pair, const Diagnosis& diagnosis) {
  const std::int64_t session = pair.newest->message.session;
  const bool moved =
      std::any_of(diagnosis.findings.begin(), diagnosis.findings.end(),
                  [](const Finding& finding) { return finding.code == "mount_moved" && finding.certain; });
  if (!moved || pair.known.restarted_session == session) return;
  pair.known.restarted_session = session;
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

/// For listeners that came late.
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
