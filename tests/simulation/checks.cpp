// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/checks.hpp"

#include <algorithm>
#include <cstring>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/decode.hpp"
#include "pairing/accumulation.hpp"

namespace egocal::simulation {

namespace {

/// After the faults, of data time; and what a process may wait before it is started again.
constexpr std::int64_t recovery_us = 5'000'000, longest_pause_us = 5'100'000;
/// Answers are that recent while data come.
constexpr std::int64_t recent_us = 1'000'000;
/// StreamOptions::largest_jump.
constexpr std::int64_t largest_jump_us = 1'000'000;
/// Messages of a sensor that pairing knows again.
constexpr double remembered = 64;
/// After this time a command has been obeyed, and what was on its way has arrived.
constexpr std::int64_t heard_us = 200'000;
constexpr std::size_t most_state_bytes = std::size_t{6} << 20;

std::int64_t field(bus::Bytes message, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = at; i < at + 8 && i < message.size(); ++i)
    value = value << 8 | std::to_integer<std::uint64_t>(message[i]);
  return static_cast<std::int64_t>(value);
}

bool has(const Plan& plan, std::initializer_list<IncidentKind> kinds) {
  return std::any_of(plan.incidents.begin(), plan.incidents.end(), [&](const Incident& incident) {
    return std::find(kinds.begin(), kinds.end(), incident.kind) != kinds.end();
  });
}

/// Numbers between the first that came and the last, of which no message came.
std::int64_t missing(const Drive& drive, std::size_t channel, std::int64_t first_us,
                     const std::set<std::int64_t>& times) {
  return std::count_if(drive.messages.begin(), drive.messages.end(), [&](const Message& message) {
    return message.channel == channel && message.time_us > first_us && message.time_us < *times.rbegin() &&
           !times.contains(message.time_us);
  });
}

bool same_bits(const problem_t& x, const problem_t& y) {
  if (x.n_blocks != y.n_blocks || x.seq != y.seq || x.matched != y.matched || x.left_out != y.left_out ||
      x.stride != y.stride || x.weight_rotation != y.weight_rotation ||
      x.weight_translation != y.weight_translation)
    return false;
  for (std::size_t i = 0; i < x.blocks.size(); ++i)
    if (x.blocks[i].count != y.blocks[i].count || x.blocks[i].weight != y.blocks[i].weight ||
        std::memcmp(x.blocks[i].q, y.blocks[i].q, sizeof x.blocks[i].q) != 0)
      return false;
  return true;
}

std::string counts_of(const std::map<std::string, std::int64_t>& counters) {
  std::string text;
  for (const auto& [name, value] : counters)
    if (value != 0) text += (text.empty() ? "; " : ", ") + name + " " + std::to_string(value);
  return text;
}

std::string text(std::int64_t session, std::int64_t seq) {
  return "session " + std::to_string(session - HostClock::start_of_all_us) + " us, problem " +
         std::to_string(seq);
}

}  // namespace

std::vector<problem_t> undisturbed(const Drive& drive,
                                   const std::map<std::size_t, std::set<std::int64_t>>* times) {
  services::Accumulation accumulation(drive.rig);
  for (const Message& message : drive.messages) {
    if (times) {
      const auto channel = times->find(message.channel);
      if (channel == times->end() || !channel->second.contains(message.time_us)) continue;
    }
    accumulation.apply(
        {services::Input::Kind::message, static_cast<std::uint16_t>(message.channel), message.bytes});
    accumulation.take_motions();
  }
  for (std::size_t i = 0; i < drive.rig.sensors.size(); ++i)
    accumulation.apply({services::Input::Kind::give_up, static_cast<std::uint16_t>(i)});
  std::vector<problem_t> problems;
  for (services::PairSession& pair : accumulation.pairs())
    problems.push_back(pair.message().value_or(problem_t{}));
  return problems;
}

void Checks::fail(char check, const std::string& text) {
  if (!violation_) violation_ = {check, surroundings_.schedule.now_us(), text};
}

bool Checks::keeps_state(const Process& process) const {
  return !process.spec().state_file.empty() &&
         !has(surroundings_.plan, {IncidentKind::disk_full, IncidentKind::power_cut});
}

/// Wrong values may look right: what is in the statistics is not known then.
bool Checks::corrupts() const {
  const NetworkFaults& network = surroundings_.plan.network;
  return network.truncated > 0 || network.flipped > 0 || has(surroundings_.plan, {IncidentKind::hostile});
}

/// No message is lost or late for long, and no process is silent while it lives.
bool Checks::peaceful() const {
  const NetworkFaults& network = surroundings_.plan.network;
  return network.lost == 0 && !corrupts() && network.late == 0 && network.delay_us < 20'000 &&
         network.jitter_us < 20'000 &&
         !has(surroundings_.plan, {IncidentKind::stop, IncidentKind::away, IncidentKind::partition,
                                   IncidentKind::clog, IncidentKind::flood, IncidentKind::power_cut});
}

/// What overtakes others does so by less than what is taken for a log that begins anew.
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

bool Checks::forgets() const {
  return std::any_of(processes_.begin(), processes_.end(), [this](const auto& process) {
    return process->spec().part == Part::pairing && process->lives() > 1 && !keeps_state(*process);
  });
}

void Checks::sent(const Address& from, const std::string& channel, bus::Bytes message) {
  const Process& sender = process(from);
  if (sender.spec().part != Part::pairing) return;
  if (channel.starts_with(bus::problem_prefix)) return problem_sent(sender, channel, message);
  status_t status{};
  if (channel == bus::status_channel && bus::decode(message, status)) status_sent(sender, status);
}

void Checks::problem_sent(const Process& from, const std::string& channel, bus::Bytes message) {
  const std::pair<std::int64_t, std::int64_t> now{field(message, 16), field(message, 24)};
  Lineage& lineage = lineages_[from.spec().name + from.spec().state_file];
  const auto before = lineage.problems.find(channel);
  if (before != lineage.problems.end() && now < before->second && (keeps_state(from) || lineage.lives == 1))
    fail('e', channel + " goes back from " + text(before->second.first, before->second.second) + " to " +
                  text(now.first, now.second));
  lineage.problems[channel] = now;
  newest_problem_[channel].assign(message.begin(), message.end());
  if (!peaceful()) return;
  check_wishes(from, channel, now.first, now.second);
  for (const auto& other : processes_)
    if (other.get() != &from && other->runs() && other->spec().name == from.spec().name &&
        other->started_us() < from.started_us())
      fail('e', "a " + from.spec().name + " that was started at " + std::to_string(from.started_us()) +
                    " us sends problems while an older one, of " + std::to_string(other->started_us()) +
                    " us, is running");
}

void Checks::commanded(const std::string& verb, const std::string& a, const std::string& b) {
  const std::int64_t now = surroundings_.schedule.now_us();
  for (const bus::PairConfig& pair : surroundings_.drive.rig.pairs) {
    if (!a.empty() && (pair.a != a || pair.b != b)) continue;
    Wish& wish = wishes_[bus::problem_channel(pair.a, pair.b)];
    if (verb == "reset") wish.reset_us = now;
    if (verb == "pause" && wish.paused_us < 0) wish.paused_us = now;
    if (verb == "resume") wish.paused_us = wish.paused_seq = -1;
  }
}

/// A new session begins where it was asked for or the log begins anew, and nowhere else.
void Checks::check_wishes(const Process& from, const std::string& channel, std::int64_t session,
                          std::int64_t seq) {
  const Plan& plan = surroundings_.plan;
  const bool one_state = from.lives() == 1 || keeps_state(from);
  if (!one_state || player_starts_ > 1 || !keeps_order() || has(plan, {IncidentKind::twin})) return;
  const std::int64_t now = surroundings_.schedule.now_us();
  Wish& wish = wishes_[channel];
  const auto before = sessions_.find(channel);
  const bool anew = before != sessions_.end() && before->second != session;
  if (anew && wish.reset_us < 0) fail('e', "a session of " + channel + " begins anew without a reason");
  if (anew || before == sessions_.end()) wish.reset_us = -1;
  sessions_[channel] = session;
  // a process that was not there when the command came knows nothing of it
  if (from.lives() > 1) return;
  if (wish.reset_us >= 0 && now > wish.reset_us + heard_us && wish.paused_us < 0 && !anew)
    fail('h', channel + " goes on in its session after a reset");
  if (wish.paused_us < 0 || now < wish.paused_us + heard_us) return;
  if (wish.paused_seq >= 0 && seq > wish.paused_seq) fail('h', channel + " goes on although it is paused");
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
    if (promised && before != lineage.acknowledged.end() && acknowledgement.utime < before->second)
      fail('a', "what was acknowledged on " + acknowledgement.channel + " until " +
                    std::to_string(before->second - HostClock::start_of_all_us) +
                    " us has been forgotten: now it is acknowledged until " +
                    std::to_string(acknowledgement.utime - HostClock::start_of_all_us) + " us");
    lineage.acknowledged[acknowledgement.channel] = acknowledgement.utime;
  }
  lineage.counters.clear();
  for (const counter_t& counter : status.counters) {
    lineage.counters[counter.name] = counter.value;
    if (counter.value < 0) fail('d', "the count '" + counter.name + "' is negative");
  }
}

void Checks::received(const Address& by, std::string_view channel, bus::Bytes message) {
  const Process& listener = process(by);
  if (listener.spec().part != Part::pairing) return;
  const auto& sensors = surroundings_.drive.rig.sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (channel != sensors[i].channel) continue;
    Lineage& lineage = lineages_[listener.spec().name + listener.spec().state_file];
    if (lineage.sensors[i].received++ == 0) lineage.sensors[i].first = field(message, 8);
    lineage.sensors[i].numbers.insert(field(message, 8));
    lineage.all[i].insert(field(message, 8));
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
      for (const auto& [channel, problem] : newest_problem_) begun_before_[channel] = field(problem, 16);
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

std::string Checks::missing_answer() const {
  const std::int64_t data_us = surroundings_.schedule.now_us() + HostClock::start_of_all_us;
  const std::int64_t end_us = surroundings_.drive.messages.back().time_us;
  const bool live = surroundings_.plan.input == Input::live;
  for (const auto& process : processes_) {
    if (const Watcher* watcher = process->watcher())
      for (const monitor::PairState& pair : watcher->model().pairs()) {
        const calibration_t* answer = pair.answer();
        const std::string whose = process->spec().name + " for " + pair.a + ", " + pair.b + ": ";
        if (!answer) return whose + "no answer";
        if (!pair.counted_solver()->verified) return whose + "an answer that is not verified";
        if (answer->status != 0) return whose + "an answer that is not certified";
        if (live && answer->utime < std::min(data_us, end_us) - recent_us) return whose + "an old answer";
        const auto newest = newest_problem_.find(bus::problem_channel(pair.a, pair.b));
        if (newest == newest_problem_.end() || answer->session != field(newest->second, 16))
          return whose + "an answer of another session";
      }
    if (const Exporter* exporter = process->exporter())
      for (const bus::PairConfig& pair : surroundings_.drive.rig.pairs) {
        const tools::Answers::Best* best = exporter->answers().best({pair.a, pair.b});
        const std::string whose = process->spec().name + " for " + pair.a + ", " + pair.b + ": ";
        if (!best) return whose + "no answer";
        if (!best->certified()) return whose + "an answer that is not certified";
        if (live && best->message.utime < std::min(data_us, end_us) - recent_us)
          return whose + "an old answer";
        const auto newest = newest_problem_.find(bus::problem_channel(pair.a, pair.b));
        if (newest == newest_problem_.end() || best->message.session != field(newest->second, 16))
          return whose + "an answer of another session";
      }
  }
  return "";
}

void Checks::look_at_answers() {
  const std::int64_t now = surroundings_.schedule.now_us();
  // a damaged message that looks right may name a session of the future
  if (corrupts() || (surroundings_.plan.input == Input::player && forgets())) return;
  const std::string missing = missing_answer();
  if (missing.empty()) {
    answers_missing_since_us_ = -1;
    answered_until_us_ = now;
    return;
  }
  if (answers_missing_since_us_ < 0) answers_missing_since_us_ = now;
  const std::int64_t quiet_from =
      std::max({surroundings_.plan.disturbed_us, last_start_us_, answers_missing_since_us_});
  if (now > quiet_from + recovery_us && now < surroundings_.plan.disturbed_us + surroundings_.plan.quiet_us)
    fail('f', "5 s after the faults are over: " + missing);
}

void Checks::finish() {
  for (const auto& process : processes_)
    if (!process->runs() && !process->retired() && process->spec().supervised &&
        process->spec().part != Part::player)
      fail('f', process->spec().name + " is not running in the end");
  // pairing that was killed behind the end of the log without a state has nothing to send again
  const bool forgot = corrupts() || (surroundings_.plan.input == Input::player &&
                                     (forgets() || has(surroundings_.plan, {IncidentKind::command})));
  if (const std::string missing = missing_answer(); !missing.empty() && !forgot)
    fail('f', "in the end: " + missing);
  compare_with_undisturbed();
  check_counts();
  check_bounds();
}

void Checks::compare_with_undisturbed() {
  const Plan& plan = surroundings_.plan;
  if (corrupts() ||
      has(plan, {IncidentKind::hostile, IncidentKind::command, IncidentKind::twin, IncidentKind::flood}))
    return;
  const Process* const pairing = processes_.front().get();
  const Lineage& lineage = lineages_[pairing->spec().name + pairing->spec().state_file];
  const auto& times = lineage.all;
  const auto count = [&](const std::string& name) {
    const auto entry = lineage.counters.find(name);
    return entry == lineage.counters.end() ? 0 : entry->second;
  };
  std::int64_t distinct = 0, held_back = 0;
  for (const auto& [channel, numbers] : times) distinct += static_cast<std::int64_t>(numbers.size());
  for (const auto& [name, value] : lineage.counters)
    if (name.starts_with("held back")) held_back += value;
  const std::int64_t used = count("in") - count("rejected: duplicate") - count("rejected: too late") -
                            count("rejected: time or number jumps") - held_back;
  // a player sends again what is missing; after a restart it begins another session with all of it
  const bool in_place = plan.numbered || plan.network.jitter_us == 0;
  const bool all_promised = plan.input == Input::player && peaceful() &&
                            (keeps_state(*pairing) || pairing->lives() == 1) && in_place;
  if (all_promised && player_starts_ == 1 &&
      used != static_cast<std::int64_t>(surroundings_.drive.messages.size()))
    fail('a', "of " + std::to_string(surroundings_.drive.messages.size()) + " messages " +
                  std::to_string(used) + " are in the statistics");
  // else what is in the statistics is known where it is all that came, each in its place
  if (!all_promised && (used != distinct || player_starts_ > 1 || !plan.numbered || !keeps_order())) return;
  if (plan.input == Input::player && forgets()) return;
  if (all_promised)
    for (const auto& [channel, session] : begun_before_)
      if (field(newest_problem_[channel], 16) <= session)
        fail('e', "the log was begun anew, and " + channel + " goes on in its session");
  ++compared_;
  const std::vector<problem_t> expected = undisturbed(surroundings_.drive, all_promised ? nullptr : &times);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bus::PairConfig& pair = surroundings_.drive.rig.pairs[i];
    const auto newest = newest_problem_.find(bus::problem_channel(pair.a, pair.b));
    problem_t found{};
    if (newest == newest_problem_.end() || !bus::decode(newest->second, found))
      fail('b', "no problem was ever sent for " + pair.a + ", " + pair.b);
    else if (!same_bits(found, expected[i]))
      fail('b', "the statistics of " + pair.a + ", " + pair.b + " hold " + std::to_string(found.matched) +
                    " of " + std::to_string(found.seq) + " motion pairs; without faults they hold " +
                    std::to_string(expected[i].matched) + " of " + std::to_string(expected[i].seq) +
                    " for the same messages" +
                    (found.seq == expected[i].seq && found.matched == expected[i].matched ? ", and other bits"
                                                                                          : "") +
                    counts_of(lineage.counters));
  }
}

void Checks::check_counts() {
  const Plan& plan = surroundings_.plan;
  if (corrupts() || has(plan, {IncidentKind::hostile, IncidentKind::flood, IncidentKind::twin})) return;
  for (const auto& process : processes_) {
    if (process->spec().part != Part::pairing || process->lives() != 1) continue;
    const Lineage& lineage = lineages_[process->spec().name + process->spec().state_file];
    std::int64_t received = 0;
    for (const auto& [channel, sensor] : lineage.sensors) received += sensor.received;
    const auto in = lineage.counters.find("in");
    if (in == lineage.counters.end() || in->second != received)
      fail('d', "pairing says that " + std::to_string(in == lineage.counters.end() ? 0 : in->second) +
                    " messages came in; " + std::to_string(received) + " did");
    if (!plan.numbered || player_starts_ > 1 || !keeps_order()) continue;
    std::int64_t lost = 0, held_back = 0;
    for (const auto& [channel, sensor] : lineage.sensors)
      lost += missing(surroundings_.drive, channel, sensor.first, sensor.numbers);
    for (const auto& [name, value] : lineage.counters)
      if (name.starts_with("held back")) held_back += value;
    const auto shown = lineage.counters.find("lost");
    if (held_back == 0 && shown != lineage.counters.end() && shown->second != lost)
      fail('d', "pairing says that " + std::to_string(shown->second) + " messages were lost; " +
                    std::to_string(lost) + " were" + counts_of(lineage.counters));
  }
}

void Checks::check_bounds() {
  for (const auto& host : surroundings_.hosts) {
    if (host->disk.files() > 20)
      fail('g', host->name + " has " + std::to_string(host->disk.files()) + " files");
    for (const auto& process : processes_)
      if (const auto file = host->disk.find(process->spec().state_file))
        if (file->bytes.size() > most_state_bytes)
          fail('g', "a state file has " + std::to_string(file->bytes.size()) + " bytes");
  }
}

}  // namespace egocal::simulation
