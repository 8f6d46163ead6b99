// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the model makes of the processes: their states, errors, counts and rates, and the commands to them.
#include <algorithm>
#include <optional>
#include <string>

#include "answer_text.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

namespace {

/// What the monitor uses of a status, with texts of limited length; without its counters.
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

void sum_counters(ProcessState& process, const status_t& message) {
  process.in = process.out = process.lost = process.rejected = 0;
  for (const counter_t& counter : message.counters) {
    // a hostile count must not overflow the sums
    const std::int64_t value =
        std::clamp<std::int64_t>(counter.value, -(std::int64_t{1} << 50), std::int64_t{1} << 50);
    const auto add = [&](std::int64_t& sum) { sum = std::min(sum + value, std::int64_t{1} << 60); };
    if (counter.name == "in") add(process.in);
    if (counter.name == "out") add(process.out);
    if (counter.name.starts_with("lost") || counter.name.starts_with("dropped")) add(process.lost);
    if (counter.name.starts_with("rejected")) add(process.rejected);
  }
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

void Model::on_status(const status_t& message, Now now) {
  now_ = now;
  ++messages_;
  const std::string name = bounded(message.name), host = bounded(message.host);
  // several people may watch
  const bool is_monitor = message.role == bus::role_name(Role::monitor);
  ProcessState* process = nullptr;
  for (ProcessState& candidate : processes_)
    if (candidate.status.name == name && candidate.status.host == host &&
        (!is_monitor || candidate.status.pid == message.pid))
      process = &candidate;
  const std::string state_text = bounded(message.state), error = bounded(message.last_error);
  const std::optional<bus::State> state = bus::state_from_name(message.state);
  if (!process) {
    if (processes_.size() == max_processes) {
      auto gone = std::find_if(processes_.begin(), processes_.end(), [](const auto& p) { return !p.alive; });
      if (gone == processes_.end()) {
        ++ignored_;
        return;
      }
      processes_.erase(gone);
    }
    process = &processes_.emplace_back();
    process->rate_in = process->rate_out = -1;
    process->alive = state != bus::State::ended;
    if (process->alive) note(Severity::good, name, "process is there (" + state_text + ")", now);
    if (!error.empty()) note(Severity::warning, name, error, now);
  } else {
    const bool ended = state == bus::State::ended;
    const bool restarted = process->status.run != message.run;
    if (restarted && process->alive && process->status.pid != message.pid &&
        message.run < process->status.run) {
      note(Severity::warning, name, "a second process of this name is running", now);
    } else if (restarted) {
      note(Severity::good, name, process->alive ? "process was restarted" : "process is back", now);
    } else if (!process->alive && !ended) {
      note(Severity::good, name, "process is back", now);
    } else if (process->status.state != state_text) {
      const bool healthy = ended || state == bus::State::running || state == bus::State::standby;
      note(healthy ? Severity::info : Severity::warning, name,
           "changed from " + process->status.state + " to " + state_text, now);
    }
    if (error != process->status.last_error && !error.empty()) note(Severity::warning, name, error, now);
    process->alive = !ended;
    if (restarted) process->rate_mono_us = 0;
  }
  process->at = now;
  process->status = bounded_status(message);
  process->state = state;

  watch_rejections(*process, message, now);
  sum_counters(*process, message);
  update_rates(*process, now);
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
    }
  const std::string subject = message.sensor_a.empty() && message.sensor_b.empty()
                                  ? std::string("all pairs")
                                  : pair_name(bounded(message.sensor_a), bounded(message.sensor_b));
  note(Severity::info, bounded(subject),
       "command: " + bounded(message.verb) + (message.to == "*" ? "" : " to " + bounded(message.to)), now);
}

}  // namespace egocal::monitor
