// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How the model handles the processes: states, errors, counts and rates, and the commands to them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "answer_text.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

namespace {

/// The part of a status that the monitor uses, without its counters, with texts of limited length.
status_t bounded_status(const status_t& message) {
  status_t status{};
  status.utime = message.utime;
  status.name = bounded(message.name);
  status.role = bounded(message.role);
  status.host = bounded(message.host);
  status.pid = message.pid;
  status.run = message.run;
  status.version = bounded(message.version);
  status.state = bounded(message.state);
  status.last_error = bounded(message.last_error);
  return status;
}

std::string rounded(double seconds) {
  return std::to_string(std::llround(seconds));
}

/// Messages per second since the last update; -1 where they are not known.
void update_rates(ProcessState& process, Now now) {
  const double elapsed = seconds_between(process.rate_mono_us, now.mono_us);
  if (process.rate_mono_us == 0 || process.in < process.rate_in_count || elapsed < 0) {
    process.rate_in = process.rate_out = -1;
  } else if (elapsed >= 0.7) {
    process.rate_in = static_cast<double>(process.in - process.rate_in_count) / elapsed;
    process.rate_out = static_cast<double>(process.out - process.rate_out_count) / elapsed;
  } else {
    return;  // changes come in bursts, a rate needs a while
  }
  if (!process.alive) process.rate_in = process.rate_out = -1;
  process.rate_mono_us = now.mono_us;
  process.rate_in_count = process.in;
  process.rate_out_count = process.out;
}

}  // namespace

bool Model::is_own(const ProcessState& process) const {
  return options_.own_pid != 0 && process.status.pid == options_.own_pid &&
         process.status.host == options_.own_host;
}

/// The process that a status is of; null: it is new. Several people may watch: monitors are told apart by
/// their numbers.
ProcessState* Model::process_of(const status_t& message) {
  const std::string name = bounded(message.name), host = bounded(message.host);
  const bool is_monitor = message.role == bus::role_name(Role::monitor);
  ProcessState* process = nullptr;
  for (ProcessState& candidate : processes_)
    if (candidate.status.name == name && candidate.status.host == host &&
        (!is_monitor || candidate.status.pid == message.pid))
      process = &candidate;
  return process;
}

/// A process that was not there, in the place of one that is gone where there are many; null: there is no
/// place.
ProcessState* Model::new_process(const status_t& message, Now now) {
  if (processes_.size() == max_processes) {
    auto gone = std::find_if(processes_.begin(), processes_.end(), [](const auto& p) { return !p.alive; });
    if (gone == processes_.end()) return nullptr;
    processes_.erase(gone);
  }
  ProcessState& process = processes_.emplace_back();
  process.rate_in = process.rate_out = -1;
  process.alive = bus::state_from_name(message.state) != bus::State::ended;
  if (process.alive)
    note(Severity::good, bounded(message.name), "process is there (" + bounded(message.state) + ")", now);
  return &process;
}

/// Reports what a status changes of a process that is known: another run, its end or return, its state.
void Model::follow(ProcessState& process, const status_t& message, Now now) {
  const std::string name = bounded(message.name), state_text = bounded(message.state);
  const std::optional<bus::State> state = bus::state_from_name(message.state);
  const bool ended = state == bus::State::ended, restarted = process.status.run != message.run;
  const std::pair<std::int64_t, std::int32_t> run{message.run, message.pid};
  if (restarted && process.alive && !ended && process.run_before == run) {
    note(Severity::warning, name, "a second process of this name is running", now);
  } else if (restarted) {
    note(Severity::good, name, process.alive ? "process was restarted" : "process is back", now);
  } else if (!process.alive && !ended) {
    note(Severity::good, name, "process is back", now);
  } else if (process.status.state != state_text) {
    // a pause was asked for
    const bool healthy =
        ended || state == bus::State::running || state == bus::State::standby || state == bus::State::paused;
    note(healthy ? Severity::info : Severity::warning, name,
         "changed from " + process.status.state + " to " + state_text, now);
  }
  if (process.state == bus::State::paused && state != bus::State::paused)
    process.resumed_mono_us = now.mono_us;
  process.alive = !ended;
  if (!restarted) return;
  process.run_before = {process.status.run, process.status.pid};
  process.rate_mono_us = 0;
  for (PairState& pair : pairs_)
    for (SolverTrack& track : pair.solvers)
      if (track.name == name) track.settled = false;
}

void Model::on_status(const status_t& message, Now now) {
  now_ = now;
  ++messages_;
  ProcessState* process = process_of(message);
  const bool is_new = !process, restarted = process && process->status.run != message.run;
  if (process) {
    follow(*process, message, now);
  } else if (process = new_process(message, now); !process) {
    ++ignored_;
    return;
  }
  process->at = now;
  process->announced = bus::announced_silence(message);
  process->computes = false;
  process->status = bounded_status(message);
  process->state = bus::state_from_name(message.state);

  watch_error(*process, bounded(message.last_error), now);
  watch_seeks(*process, message, is_new || restarted, now);
  count_messages(*process, message, is_new, now);
  update_rates(*process, now);
  if (!process->alive) process->rate_in = process->rate_out = -1;
}

/// Reports errors that last. Processes that resume, or have a network again, hear of each other one after the
/// other, so a process that they miss for a moment is not missing.
void Model::watch_error(ProcessState& process, const std::string& error, Now now) {
  if (error.empty()) process.reported_error.clear();
  if (error == process.reported_error || network_away_) return;
  const std::int64_t since = std::max(process.resumed_mono_us.value_or(0), network_mono_us_);
  if (since > 0 && seconds_between(since, now.mono_us) < options_.heartbeat_timeout) return;
  process.reported_error = error;
  note(Severity::warning, process.status.name, error, now);
}

/// Without a network this monitor cannot know who is gone.
void Model::watch_processes(Now now) {
  for (ProcessState& process : processes_) {
    const bool own = is_own(process);
    if (own) process.at = now;
    process.known = own || !network_away_;
    if (!process.known) process.rate_in = process.rate_out = -1;
    const double silent = seconds_between(std::max(process.at.mono_us, network_mono_us_), now.mono_us);
    process.computes = false;
    if (!process.alive || !process.known || silent <= options_.heartbeat_timeout) continue;
    const double announced = std::chrono::duration<double>(process.announced).count();
    process.rate_in = process.rate_out = -1;
    process.computes = silent <= announced;
    if (process.computes) continue;
    process.alive = false;
    note(Severity::bad, process.status.name,
         "process is gone: no heartbeat for " + rounded(std::max(options_.heartbeat_timeout, announced)) +
             " s",
         now);
  }
}

bool Model::pairing_has_ended() const {
  bool ended = false;
  for (const ProcessState& process : processes_) {
    if (process.status.role != bus::role_name(Role::pairing)) continue;
    if (process.state != bus::State::ended) return false;
    ended = true;
  }
  return ended;
}

bool Model::heard_others() const {
  return std::any_of(processes_.begin(), processes_.end(), [this](const auto& p) { return !is_own(p); }) ||
         std::any_of(pairs_.begin(), pairs_.end(), [](const auto& p) { return p.answer() || p.has_problem; });
}

void Model::set_network(const std::string& error, Now now) {
  now_ = now;
  if (error.empty())
    note(Severity::good, "network", "the network is back", now);
  else
    note(Severity::bad, "network", error, now);
  if (network_away_ == !error.empty()) return;
  network_away_ = !error.empty();
  network_mono_us_ = now.mono_us;
  watch_processes(now);
}

void Model::on_command(const command_t& message, Now now) {
  now_ = now;
  ++messages_;
  const bool to_pairing =
      message.to == "*" || std::any_of(processes_.begin(), processes_.end(), [&](const auto& p) {
        return p.status.name == message.to && p.status.role == bus::role_name(Role::pairing);
      });
  if (to_pairing && (message.verb == "pause" || message.verb == "resume"))
    for (PairState& pair : pairs_) {
      const bool all = message.sensor_a.empty() && message.sensor_b.empty();
      if (!all && (message.sensor_a != pair.a || message.sensor_b != pair.b)) continue;
      pair.paused = message.verb == "pause";
      pair.paused_mono_us = now.mono_us;
      if (pair.paused) interrupt(pair, Interruption::Kind::pause, 1, now);
    }
  if (to_pairing && message.verb == "reset")
    for (PairState& pair : pairs_)
      if ((message.sensor_a.empty() && message.sensor_b.empty()) ||
          (message.sensor_a == pair.a && message.sensor_b == pair.b))
        pair.reset_asked = pair.session;
  const std::string subject = message.sensor_a.empty() && message.sensor_b.empty()
                                  ? std::string("all pairs")
                                  : pair_name(bounded(message.sensor_a), bounded(message.sensor_b));
  note(Severity::info, bounded(subject),
       "command: " + bounded(message.verb) + (message.to == "*" ? "" : " to " + bounded(message.to)), now);
}

}  // namespace egocal::monitor
