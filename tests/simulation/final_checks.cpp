// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is checked when a life is over.
#include <algorithm>
#include <cstring>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/decode.hpp"
#include "pairing/accumulation.hpp"
#include "simulation/checks.hpp"
#include "simulation/checks_common.hpp"

namespace egocal::simulation {

namespace {

/// Of one pairing process [bytes].
constexpr std::size_t most_state_bytes = std::size_t{6} << 20;

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

void Checks::finish() {
  for (const auto& process : processes_)
    if (!process->runs() && !process->retired() && process->spec().supervised &&
        process->spec().part != Part::player)
      fail('f', process->spec().name + " is not running in the end");
  // pairing that was killed behind the end of the log without a state has nothing to send again
  const bool forgot = corrupts() || surroundings_.plan.mistake > 0 || in_an_order_of_its_own() ||
                      (surroundings_.plan.input == Input::player &&
                       (forgets() || has(surroundings_.plan, {IncidentKind::command})));
  const bool just_changed = surroundings_.schedule.now_us() < sender_changed_us_ + recovery_us;
  if (const std::string missing = missing_answer(); !missing.empty() && !forgot && !just_changed)
    fail('f', "in the end: " + missing);
  compare_with_undisturbed();
  check_counts();
  check_losses();
  check_certificates();
  check_scales();
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
  std::int64_t distinct = 0, held_back = 0, not_decodable = 0;
  for (const auto& [channel, numbers] : times) distinct += static_cast<std::int64_t>(numbers.size());
  for (const auto& [name, value] : lineage.counters)
    if (name.starts_with("held back")) held_back += value;
  for (const bus::Sensor& sensor : surroundings_.drive.rig.sensors)
    not_decodable += count("rejected: not decodable on " + sensor.channel);
  const std::int64_t used = count("in") - count("rejected: duplicate") - count("rejected: too late") -
                            count("rejected: time or number jumps") - not_decodable - held_back;
  // a player sends again what is missing; after a restart it begins another session with all of it
  // a copy that overtakes what fills the gap is taken for a sign that nothing will; that loss is counted
  const bool in_place = plan.network.jitter_us == 0 || (plan.numbered && plan.network.duplicated == 0);
  const bool all_promised = plan.input == Input::player && peaceful() &&
                            (keeps_state(*pairing) || pairing->lives() == 1) && in_place;
  if (all_promised && player_starts_ == 1 &&
      used != static_cast<std::int64_t>(surroundings_.drive.messages.size()))
    fail('a', "of " + std::to_string(surroundings_.drive.messages.size()) + " messages " +
                  std::to_string(used) + " are in the statistics");
  // else what is in the statistics is known where it is all that came, each in its place
  if (!all_promised && (used != distinct || player_starts_ > 1 || !plan.numbered || !keeps_order())) return;
  // what a state holds that may have been lost, and was not, is not known
  if (!keeps_state(*pairing) && count("restored") > 0) return;
  if (plan.input == Input::player && forgets()) return;
  if (all_promised)
    for (const auto& [channel, session] : begun_before_)
      if (field(newest_problem_[channel], session_at) <= session)
        fail('e', "the log began again, and " + channel + " continues its session");
  ++compared_;
  const std::vector<problem_t> expected = undisturbed(surroundings_.drive, all_promised ? nullptr : &times);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bus::PairConfig& pair = surroundings_.drive.rig.pairs[i];
    const auto newest = newest_problem_.find(bus::problem_channel(pair.a, pair.b));
    problem_t found{};
    if (newest == newest_problem_.end() && expected[i].seq == 0) continue;  // of unknown scale
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
      fail('d', "pairing reports that " + std::to_string(in == lineage.counters.end() ? 0 : in->second) +
                    " messages came in; " + std::to_string(received) + " did");
    if (!plan.numbered || player_starts_ > 1 || !keeps_order()) continue;
    // a player sends again what came before the first one that was received: a new timeline, behind whose
    // start some of what was lost in the first may be
    if (std::any_of(lineage.sensors.begin(), lineage.sensors.end(), [](const auto& entry) {
          const std::set<std::int64_t>& times = entry.second.numbers;
          return !times.empty() && entry.second.first - *times.begin() >= largest_jump_us;
        }))
      continue;
    std::int64_t lost = 0, held_back = 0;
    for (const auto& [channel, sensor] : lineage.sensors)
      lost += missing(surroundings_.drive, channel, sensor.first, sensor.numbers);
    for (const auto& [name, value] : lineage.counters)
      if (name.starts_with("held back")) held_back += value;
    const auto shown = lineage.counters.find("lost");
    // what came far off and was rejected is missing where its number would have been
    const auto rejected = lineage.counters.find("rejected: time or number jumps");
    const std::int64_t most = lost + (rejected == lineage.counters.end() ? 0 : rejected->second);
    if (held_back == 0 && shown != lineage.counters.end() && (shown->second < lost || shown->second > most))
      fail('d', "pairing reports that " + std::to_string(shown->second) + " messages were lost; " +
                    std::to_string(lost) + " were" + counts_of(lineage.counters));
  }
}

/// The losses that live processes report are those of the network.
void Checks::check_losses() {
  for (const auto& process : processes_) {
    if (!process->runs()) continue;
    const std::uint64_t port = process->port();
    const auto counters = counters_.find(port);
    if (counters == counters_.end()) continue;
    const Network::Losses losses = surroundings_.network.losses(port);
    for (const auto& [name, happened] : {std::pair{"not sent", losses.not_sent},
                                         std::pair{"dropped: receive buffer full", losses.overflow}}) {
      const auto shown = counters->second.find(name);
      const std::int64_t count = shown == counters->second.end() ? 0 : shown->second;
      if (count != happened)
        fail('d', process->spec().name + " says '" + name + "': " + std::to_string(count) + "; it happened " +
                      std::to_string(happened) + " times");
    }
  }
}

/// The answers that a person sees in the end.
void Checks::check_certificates() {
  if (corrupts()) return;
  for (const auto& process : processes_)
    if (const Exporter* exporter = process->exporter())
      for (const auto& [pair, best] : exporter->answers().all()) {
        if (!best.certified()) continue;
        const std::string objection =
            certificates_.objection(bus::problem_channel(pair.first, pair.second), best.message);
        if (!objection.empty()) fail('c', "what egocal-export takes: " + objection);
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
