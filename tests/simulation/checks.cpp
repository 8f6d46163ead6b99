// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/decode.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/verdict_t.hpp"
#include "simulation/allocations.hpp"
#include "simulation/checks_common.hpp"

namespace egocal::simulation {

namespace {

/// Greatest age of an answer while data arrive: a pose waits for four periods of the other stream.
std::int64_t recent_us(const Plan& plan) {
  return 1'000'000 + std::llround(4e6 / plan.rate_hz);
}
/// Messages of a sensor that pairing knows again.
constexpr double remembered = 64;
/// After this time a command has been obeyed, and messages in flight have arrived.
constexpr std::int64_t heard_us = 200'000;
/// Largest memory of a process [bytes]. A pair takes up to 2.5 MB, and a life has four pairs; before 64 poses
/// pairing holds a second copy, with choices made early.
constexpr std::size_t largest_memory = std::size_t{12} << 20;
/// Arithmetic of 113 bits takes as long as all the rest of a short life: one answer of this number is
/// checked.
constexpr std::uint64_t one_certificate_of = 32;

std::string text(std::int64_t session, std::int64_t seq) {
  return "session " + std::to_string(session - HostClock::start_of_all_us) + " us, problem " +
         std::to_string(seq);
}

}  // namespace

void Checks::fail(char check, const std::string& text) {
  if (!violation_) violation_ = {check, surroundings_.schedule.now_us(), text};
}

bool Checks::keeps_state(const Process& process) const {
  return !process.spec().state_file.empty() &&
         !has(surroundings_.plan, {IncidentKind::disk_full, IncidentKind::power_cut, IncidentKind::read_only,
                                   IncidentKind::old_state});
}

/// Whether values are corrupted: some may look right, so the statistics are then unknown.
bool Checks::corrupts() const {
  const NetworkFaults& network = surroundings_.plan.network;
  return network.truncated > 0 || network.flipped > 0 || has(surroundings_.plan, {IncidentKind::hostile});
}

/// Whether no message is lost or late for long, and no live process is silent.
bool Checks::peaceful() const {
  const NetworkFaults& network = surroundings_.plan.network;
  return network.lost == 0 && network.burst == 0 && !corrupts() && network.late == 0 &&
         network.delay_us < 20'000 && network.jitter_us < 20'000 &&
         !has(surroundings_.plan,
              {IncidentKind::stop, IncidentKind::away, IncidentKind::partition, IncidentKind::clog,
               IncidentKind::flood, IncidentKind::power_cut, IncidentKind::slow_disk});
}

/// Whether messages overtake others by less than what is taken for a log that starts again.
bool Checks::keeps_order() const {
  const Plan& plan = surroundings_.plan;
  const std::int64_t late_us = plan.network.jitter_us + (plan.network.late > 0 ? plan.network.late_by_us : 0);
  if (plan.input == Input::live) return late_us < largest_jump_us;
  // a player that was kept from sending has much to make up for
  if (late_us > 0 &&
      has(plan, {IncidentKind::stop, IncidentKind::away, IncidentKind::kill, IncidentKind::partition}))
    return false;
  return plan.speed > 0 ? static_cast<double>(late_us) * plan.speed < largest_jump_us : late_us == 0;
}

/// Whether the order cannot be restored: messages have no numbers, and some arrive so late that they look
/// like a log that starts again.
bool Checks::in_an_order_of_its_own() const {
  return !surroundings_.plan.numbered && !keeps_order();
}

bool Checks::forgets() const {
  return std::any_of(processes_.begin(), processes_.end(), [this](const auto& process) {
    return process->spec().part == Part::pairing && process->lives() > 1 && !keeps_state(*process);
  });
}

void Checks::sent(const Address& from, const std::string& channel, bus::Bytes message) {
  const Process& sender = process(from);
  if (channel.starts_with(bus::problem_prefix)) return problem_sent(sender, channel, message);
  if (channel.starts_with(bus::calibration_prefix)) return answer_sent(sender, channel, message);
  if (channel.starts_with(bus::verdict_prefix)) return verdict_sent(sender, message);
  if (channel.starts_with(bus::scale_problem_prefix)) return scale_problem_sent(channel, message);
  if (channel.starts_with(bus::scale_prefix)) return scale_sent(sender, message);
  status_t status{};
  if (channel != bus::status_channel || !bus::decode(message, status)) return;
  std::map<std::string, std::int64_t>& counters = counters_[from.port];
  counters.clear();
  for (const counter_t& counter : status.counters) {
    counters[counter.name] = counter.value;
    if (counter.value < 0) fail('d', "the count '" + counter.name + "' is negative");
  }
  if (sender.spec().part == Part::pairing) status_sent(sender, status);
}

void Checks::problem_sent(const Process& from, const std::string& channel, bus::Bytes message) {
  const std::pair<std::int64_t, std::int64_t> now{field(message, session_at), field(message, seq_at)};
  Lineage& lineage = lineages_[from.spec().name + from.spec().state_file];
  const auto before = lineage.problems.find(channel);
  if (before != lineage.problems.end() && now < before->second && (keeps_state(from) || lineage.lives == 1))
    fail('e', channel + " goes back from " + text(before->second.first, before->second.second) + " to " +
                  text(now.first, now.second));
  lineage.problems[channel] = now;
  newest_problem_[channel].assign(message.begin(), message.end());
  problem_sent_us_[channel] = surroundings_.schedule.now_us();
  const std::uint64_t last_sender = std::exchange(sender_of_problems_, from.port());
  if (last_sender != 0 && last_sender != from.port()) sender_changed_us_ = surroundings_.schedule.now_us();
  certificates_.take_problem(channel, message);
  if (!peaceful()) return;
  check_wishes(from, channel, now.first, now.second);
  check_leader(from);
}

/// Checks which of several pairing processes of one name continues: the one that sent first; before that the
/// older one, as far as the dates of their starts show.
void Checks::check_leader(const Process& from) {
  const auto object = [&](const Process& other, const std::string& which) {
    fail('e', "a " + from.spec().name + " that was started at " + std::to_string(from.started_us()) +
                  " us sends problems while " + which + ", of " + std::to_string(other.started_us()) +
                  " us, is running");
  };
  const std::uint64_t leader = std::exchange(leaders_[from.spec().name], from.port());
  const bool dates_are_set = has(surroundings_.plan, {IncidentKind::set_date});
  for (const auto& other : processes_) {
    if (other.get() == &from || !other->runs() || other->spec().name != from.spec().name) continue;
    if (other->port() == leader)
      object(*other, "one that sends already");
    else if (!dates_are_set && !dates_differ() && other->started_us() < from.started_us())
      object(*other, "an older one");
  }
}

/// Whether the dates of the hosts differ, by which the starts of their processes are compared.
bool Checks::dates_differ() const {
  const Plan& plan = surroundings_.plan;
  for (int i = 1; i < plan.hosts; ++i)
    if (plan.clocks[i].wall_off_us != plan.clocks[0].wall_off_us ||
        plan.clocks[i].drift_ppm != plan.clocks[0].drift_ppm)
      return true;
  return false;
}

void Checks::answer_sent(const Process& from, const std::string& channel, bus::Bytes message) {
  if (corrupts()) return;
  const std::string pair = channel.substr(bus::calibration_prefix.size());
  const std::string problems = std::string(bus::problem_prefix) + pair;
  const std::int64_t session = field(message, session_at), seq = field(message, seq_at);
  if (!certificates_.knows(problems, session, seq))
    return fail('e', from.spec().name + " answers what was never asked: " + text(session, seq));
  if (hash_of(message.data(), message.size()) % one_certificate_of == 0) {
    calibration_t answer{};
    if (!bus::decode(message, answer)) return fail('c', "an answer that cannot be decoded");
    if (const std::string objection = certificates_.objection(problems, answer); !objection.empty())
      fail('c', "an answer of " + from.spec().name + ": " + objection);
  }
  const Commands::Wish& wish = commands_.of(from.spec().name, pair);
  const std::int64_t obeyed_us = wish.paused_us + heard_us + 2 * surroundings_.plan.burden.solvers_us;
  if (peaceful() && wish.paused_us >= 0 && from.started_us() < wish.paused_us &&
      surroundings_.schedule.now_us() > obeyed_us)
    fail('h', from.spec().name + " answers although it is paused");
}

/// What is off by this much is not good: as the study of mistakes has it (docs/trust_measured.md).
constexpr double off_rotation = 1 * std::numbers::pi / 180;  // [rad]
constexpr double off_translation = 0.6;                      // [m]

void Checks::verdict_sent(const Process& from, bus::Bytes message) {
  verdict_t verdict{};
  if (!bus::decode(message, verdict)) return fail('c', "a verdict that cannot be decoded");
  if (corrupts()) return;
  if (!certificates_.knows(bus::problem_channel(verdict.sensor_a, verdict.sensor_b), verdict.session,
                           verdict.seq))
    return fail('e', from.spec().name + " judges what was never asked");
  if (verdict.verdict != "good") return;
  ++judged_good_;
  const bus::Checked<DualQuaternion> T = bus::to_dual_quaternion(verdict.pos, verdict.quat);
  const std::vector<bus::PairConfig>& pairs = surroundings_.drive.rig.pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].a != verdict.sensor_a || pairs[i].b != verdict.sensor_b) continue;
    bool right = false;
    ExtrinsicError error;
    for (const DualQuaternion& truth : surroundings_.drive.truth[i]) {
      error = extrinsic_error(truth, T ? *T.value : DualQuaternion{});
      right = right || (error.rotation < off_rotation && error.translation < off_translation);
    }
    char text[120];
    std::snprintf(text, sizeof text, "an answer that is off by %.2f deg and %.3f m is called good",
                  error.rotation * 180 / std::numbers::pi, error.translation);
    if (!right) fail('c', text);
  }
}

void Checks::commanded(const std::string& to, const std::string& verb, const std::string& a,
                       const std::string& b) {
  commands_.command(surroundings_.schedule.now_us(), to, verb, surroundings_.drive.rig, a, b);
}

/// A new session begins on request or when the log starts again, and never otherwise.
void Checks::check_wishes(const Process& from, const std::string& channel, std::int64_t session,
                          std::int64_t seq) {
  const Plan& plan = surroundings_.plan;
  const bool one_state = from.lives() == 1 || keeps_state(from);
  if (!one_state || player_starts_ > 1 || !keeps_order() || has(plan, {IncidentKind::twin})) return;
  const std::int64_t now = surroundings_.schedule.now_us();
  Commands::Wish& wish = commands_.of("egocal-pairing", channel.substr(bus::problem_prefix.size()));
  const auto before = sessions_.find(channel);
  const bool anew = before != sessions_.end() && before->second != session;
  if (anew && wish.reset_us < 0 && !wish.on_its_way)
    fail('e', "a session of " + channel + " begins anew without a reason");
  if (anew || before == sessions_.end()) {
    wish.on_its_way = !anew && wish.reset_us >= 0 && now <= wish.reset_us + heard_us;
    wish.reset_us = -1;
  }
  sessions_[channel] = session;
  // a process that started after the command has not received it
  if (from.lives() > 1) return;
  if (wish.reset_us >= 0 && now > wish.reset_us + heard_us && wish.paused_us < 0 && !anew)
    fail('h', channel + " continues its session after a reset");
  if (wish.paused_us < 0 || now < wish.paused_us + heard_us) return;
  if (wish.paused_seq >= 0 && seq > wish.paused_seq) fail('h', channel + " continues although it is paused");
  wish.paused_seq = seq;
}

void Checks::status_sent(const Process& from, const status_t& status) {
  Lineage& lineage = lineages_[from.spec().name + from.spec().state_file];
  // a copy that comes later than its original is acknowledged by its own time
  const NetworkFaults& network = surroundings_.plan.network;
  const bool promised = keeps_state(from) && player_starts_ <= 1 && peaceful() && network.duplicated == 0 &&
                        network.jitter_us == 0;
  for (const acknowledgement_t& acknowledgement : status.acknowledgements) {
    const auto before = lineage.acknowledged.find(acknowledgement.channel);
    // what comes once more is acknowledged by its own time
    if (lineage.again[acknowledgement.channel].contains(acknowledgement.utime)) continue;
    if (promised && before != lineage.acknowledged.end() && acknowledgement.utime < before->second)
      fail('a', "what was acknowledged on " + acknowledgement.channel + " until " +
                    std::to_string(before->second - HostClock::start_of_all_us) +
                    " us has been forgotten: now it is acknowledged until " +
                    std::to_string(acknowledgement.utime - HostClock::start_of_all_us) + " us");
    lineage.acknowledged[acknowledgement.channel] = acknowledgement.utime;
  }
  lineage.counters.clear();
  for (const counter_t& counter : status.counters) lineage.counters[counter.name] = counter.value;
}

bool Checks::is_foreign(bus::Bytes message) const {
  if (!has(surroundings_.plan, {IncidentKind::foreign})) return false;
  odometry_t odometry{};
  bot_core::pose_t pose{};
  return !bus::decode(message, odometry) && !bus::decode(message, pose);
}

void Checks::received(const Address& by, std::string_view channel, bus::Bytes message) {
  const Process& listener = process(by);
  if (listener.spec().part != Part::pairing) return;
  const auto& sensors = surroundings_.drive.rig.sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (channel != sensors[i].channel) continue;
    Lineage& lineage = lineages_[listener.spec().name + listener.spec().state_file];
    if (is_foreign(message)) {
      // acknowledged by the time in its bytes, so that a player with a damaged log continues; it is not used
      lineage.again[std::string(channel)].insert(field(message, utime_at));
      ++lineage.sensors[i].received;
      continue;
    }
    if (lineage.sensors[i].numbers.empty()) lineage.sensors[i].first = field(message, utime_at);
    ++lineage.sensors[i].received;
    lineage.sensors[i].numbers.insert(field(message, utime_at));
    if (!lineage.all[i].insert(field(message, utime_at)).second)
      lineage.again[std::string(channel)].insert(field(message, utime_at));
  }
}

void Checks::started(const Process& process) {
  last_start_us_ = surroundings_.schedule.now_us();
  if (process.spec().part == Part::player && ++player_starts_ == 2) {
    const auto& acknowledged =
        lineages_[processes_.front()->spec().name + processes_.front()->spec().state_file].acknowledged;
    const double known_us = 1e6 * remembered / surroundings_.plan.rate_hz + 2 * largest_jump_us;
    if (!acknowledged.empty() &&
        static_cast<double>(acknowledged.begin()->second - HostClock::start_of_all_us) > known_us)
      for (const auto& [channel, problem] : newest_problem_)
        begun_before_[channel] = field(problem, session_at);
  }
  if (process.spec().part != Part::pairing) return;
  Lineage& lineage = lineages_[process.spec().name + process.spec().state_file];
  ++lineage.lives;
  lineage.sensors.clear();
  lineage.counters.clear();
  if (keeps_state(process)) return;
  lineage.all.clear();
  lineage.acknowledged.clear();
}

void Checks::ended(const Process& process, const Process::Ending& ending) {
  if (ending.exit_code > 0) fail('f', process.spec().name + " ended by itself: " + ending.error);
  if (ending.next == tools::Restarts::Next::hopeless) fail('f', process.spec().name + " is given up");
}

/// Pairing sends no problem before it knows the scale, nor without motions: it does not ask again for
/// messages without numbers, and a network may lose most of a short drive.
bool Checks::may_lack_a_problem(bool scaled) const {
  const NetworkFaults& network = surroundings_.plan.network;
  return scaled || (!surroundings_.plan.numbered && (network.lost > 0 || network.burst > 0));
}

/// A problem is sent once a second, unless its session is too young to have one.
bool Checks::no_longer_sent(const std::string& a, const std::string& b) const {
  const auto sent = problem_sent_us_.find(bus::problem_channel(a, b));
  return sent == problem_sent_us_.end() || surroundings_.schedule.now_us() - sent->second > 2'000'000;
}

std::string Checks::missing_answer() const {
  const std::int64_t data_us = surroundings_.schedule.now_us() + HostClock::start_of_all_us;
  const std::int64_t end_us = surroundings_.drive.messages.back().time_us;
  const bool live = surroundings_.plan.input == Input::live;
  for (const auto& process : processes_) {
    if (const Watcher* watcher = process->watcher())
      for (const monitor::PairState& pair : watcher->model().pairs()) {
        const calibration_t* answer = pair.answer();
        const std::string whose = process->spec().name + " for " + pair.a + ", " + pair.b + ": ";
        const auto newest = newest_problem_.find(bus::problem_channel(pair.a, pair.b));
        const bool scaled = is_scale_to_be_found(pair.a, pair.b);
        if (no_longer_sent(pair.a, pair.b) && may_lack_a_problem(scaled)) continue;
        if (!answer) return whose + "no answer";
        if (!pair.counted_solver()->verified) return whose + "an answer that is not verified";
        if (answer->status != 0) return whose + "an answer that is not certified";
        if (live && !scaled && answer->utime < std::min(data_us, end_us) - recent_us(surroundings_.plan))
          return whose + "an old answer";
        if (newest == newest_problem_.end() || answer->session != field(newest->second, session_at))
          return whose + "an answer of another session";
      }
    if (const Exporter* exporter = process->exporter())
      for (const bus::PairConfig& pair : surroundings_.drive.rig.pairs) {
        const tools::Answers::Best* best = exporter->answers().best({pair.a, pair.b});
        const std::string whose = process->spec().name + " for " + pair.a + ", " + pair.b + ": ";
        const auto newest = newest_problem_.find(bus::problem_channel(pair.a, pair.b));
        const bool scaled = is_scale_to_be_found(pair.a, pair.b);
        if (no_longer_sent(pair.a, pair.b) && may_lack_a_problem(scaled)) continue;
        if (!best) return whose + "no answer";
        if (!best->certified()) return whose + "an answer that is not certified";
        if (!exporter->answers().certified({pair.a, pair.b})) return whose + "an answer without its scale";
        if (live && !scaled &&
            best->message.utime < std::min(data_us, end_us) - recent_us(surroundings_.plan))
          return whose + "an old answer";
        if (newest == newest_problem_.end() || best->message.session != field(newest->second, session_at))
          return whose + "an answer of another session";
      }
  }
  return "";
}

void Checks::look_at_answers() {
  const std::int64_t now = surroundings_.schedule.now_us();
  // a damaged message that looks right may name a session of the future; a wrong drive need not have an
  // answer
  const Plan& plan = surroundings_.plan;
  // a player that is fast has little left when the faults are over and all continues after a pause
  // and a player that was restarted first sends what was received before a reset
  const bool little_left = plan.input == Input::player && (plan.speed != 1 || player_starts_ > 1) &&
                           has(plan, {IncidentKind::command});
  if (corrupts() || plan.mistake > 0 || (plan.input == Input::player && forgets()) || little_left ||
      in_an_order_of_its_own())
    return;
  const std::string missing = missing_answer();
  if (missing.empty()) {
    answers_missing_since_us_ = -1;
    answered_until_us_ = now;
    return;
  }
  if (answers_missing_since_us_ < 0) answers_missing_since_us_ = now;
  const std::int64_t quiet_from =
      std::max({plan.disturbed_us, last_start_us_, sender_changed_us_, answers_missing_since_us_});
  if (now > quiet_from + recovery_us && now < plan.disturbed_us + plan.quiet_us)
    fail('f', "5 s after the faults are over: " + missing);
}

void Checks::look_at_memory(const Process& process) {
  const std::size_t bytes = allocated_bytes(process.memory_owner());
  most_memory_ = std::max(most_memory_, bytes);
  if (bytes > largest_memory)
    fail('g', process.spec().name + " has allocated " + std::to_string(bytes) + " bytes");
}

}  // namespace egocal::simulation
