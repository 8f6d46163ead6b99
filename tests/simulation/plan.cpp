// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/plan.hpp"

#include <algorithm>
#include <cstdio>

#include "support/random_motion.hpp"

namespace egocal::simulation {

namespace {

constexpr const char* names[incident_kinds] = {
    "kill",      "stop",      "end",         "twin",    "away",  "partition", "clog",   "set the date",
    "disk full", "power cut", "old version", "hostile", "flood", "swap",      "command"};

/// Number of the first process that sends odometry.
constexpr int first_input = 5;

bool of_a_host(IncidentKind kind) {
  switch (kind) {
    case IncidentKind::away:
    case IncidentKind::partition:
    case IncidentKind::clog:
    case IncidentKind::set_date:
    case IncidentKind::disk_full:
    case IncidentKind::power_cut:
      return true;
    default:
      return false;
  }
}

std::string seconds(std::int64_t us) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g s", 1e-6 * static_cast<double>(us));
  return text;
}

std::string percent(double share) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

}  // namespace

int processes(const Plan& plan) {
  return first_input + (plan.input == Input::player ? 1 : plan.sensors);
}

std::string process_name(const Plan& plan, int number) {
  static const std::string fixed[first_input] = {"egocal-pairing", "egocal-fast", "egocal-global",
                                                 "egocal-monitor", "egocal-export"};
  if (number < first_input) return fixed[number];
  return plan.input == Input::player ? "egocal-player" : "odometry-" + std::to_string(number - first_input);
}

const char* name(IncidentKind kind) {
  return names[static_cast<int>(kind)];
}

Plan draw(std::uint64_t seed) {
  testing::Random random(seed);
  random.bits();
  const auto chance = [&](double share) { return random.uniform() < share; };
  const auto between = [&](std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(high - low)));
  };
  Plan plan;
  plan.seed = seed;
  plan.sensors = chance(0.6) ? 2 : chance(0.7) ? 3 : static_cast<int>(between(4, 6));
  const double rates[] = {5, 10, 10, 20};
  plan.rate_hz = rates[random.below(4)];
  plan.disturbed_us = between(3'000'000, 8'000'000);
  plan.quiet_us = 6'000'000;
  plan.free_motion = chance(0.7);
  plan.numbered = chance(0.8);
  plan.input = chance(0.5) ? Input::player : Input::live;
  plan.speed = chance(0.7) ? 1 : chance(0.5) ? 3 : 0;
  plan.state_file = chance(0.8);
  plan.hosts = chance(0.5) ? 1 : static_cast<int>(between(2, most_hosts + 1));
  plan.fast_method = chance(0.8) ? Method::sqp : Method::slsqp;
  plan.global_method = chance(0.9) ? Method::dual : Method::sdp;
  plan.global_always = chance(0.2);

  NetworkFaults& network = plan.network;
  network.delay_us = chance(0.5) ? 0 : between(10, 2000);
  if (chance(0.3)) network.lost = random.log_uniform(0.001, 0.3);
  if (chance(0.3)) network.duplicated = random.log_uniform(0.001, 0.3);
  if (chance(0.3)) network.jitter_us = static_cast<std::int64_t>(random.log_uniform(10, 200'000));
  if (chance(0.2)) {
    network.late = random.log_uniform(0.001, 0.1);
    network.late_by_us = static_cast<std::int64_t>(random.log_uniform(1000, 1'000'000));
  }
  // a log at full speed is over before anything late arrives: what overtakes seconds of it begins it anew
  if (plan.input == Input::player && plan.speed == 0) network.jitter_us = 0, network.late = 0;
  if (chance(0.07)) network.truncated = random.log_uniform(0.0005, 0.05);
  if (chance(0.07)) network.flipped = random.log_uniform(0.0005, 0.05);
  if (chance(0.3))
    for (ClockFaults& clock : plan.clocks) {
      clock.wall_off_us = chance(0.5) ? between(-10'000'000, 10'000'000) : 0;
      clock.drift_ppm = static_cast<int>(between(-200, 201));
    }

  // which kinds there are in this life, and how often each
  const IncidentKind kinds[] = {IncidentKind::kill,      IncidentKind::stop,        IncidentKind::end,
                                IncidentKind::away,      IncidentKind::partition,   IncidentKind::clog,
                                IncidentKind::set_date,  IncidentKind::disk_full,   IncidentKind::twin,
                                IncidentKind::power_cut, IncidentKind::old_version, IncidentKind::hostile,
                                IncidentKind::flood,     IncidentKind::swap,        IncidentKind::command};
  for (const IncidentKind kind : kinds) {
    // in few lives: little is promised then
    const bool alters = kind == IncidentKind::hostile || kind == IncidentKind::flood ||
                        kind == IncidentKind::command || kind == IncidentKind::power_cut;
    if (!chance(alters ? 0.06 : 0.2)) continue;
    const std::int64_t count = between(1, 4);
    for (std::int64_t i = 0; i < count; ++i) {
      Incident incident;
      incident.kind = kind;
      incident.at_us = between(0, plan.disturbed_us);
      incident.target = static_cast<int>(between(0, of_a_host(kind) ? plan.hosts : processes(plan)));
      // whoever ends the player wants no more of the log
      if (kind == IncidentKind::end && incident.target >= first_input) incident.target = 0;
      incident.duration_us = static_cast<std::int64_t>(random.log_uniform(10'000, 5'000'000));
      if (kind == IncidentKind::kill) {
        if (chance(0.5)) incident.target = 0;  // the one with a state
        incident.amount = chance(0.3) ? 0 : between(1, 20);
      }
      if (kind == IncidentKind::set_date)
        incident.amount =
            chance(0.5) ? between(-5'000'000, 5'000'000) : between(-86'400'000'000, 86'400'000'000);
      if (kind == IncidentKind::twin) incident.target = chance(0.6) ? 0 : static_cast<int>(between(1, 3));
      if (kind == IncidentKind::swap) incident.target = static_cast<int>(between(1, 3));
      if (kind == IncidentKind::twin || kind == IncidentKind::swap) incident.amount = between(0, 2);
      if (kind == IncidentKind::hostile || kind == IncidentKind::flood)
        incident.amount = static_cast<std::int64_t>(random.log_uniform(1, 1000));
      if (kind == IncidentKind::command) {
        incident.text = chance(0.5) ? "reset" : chance(0.5) ? "pause" : "resume";
        incident.amount = between(0, plan.sensors);
      }
      plan.incidents.push_back(incident);
    }
  }
  std::stable_sort(plan.incidents.begin(), plan.incidents.end(),
                   [](const Incident& x, const Incident& y) { return x.at_us < y.at_us; });
  return plan;
}

std::vector<Simpler> simpler(const Plan& plan) {
  std::vector<Simpler> all;
  const auto with = [&](const std::string& removed, auto change) {
    Plan other = plan;
    change(other);
    all.push_back({removed, std::move(other)});
  };
  if (plan.incidents.size() > 1) {
    with("the first half of the incidents", [](Plan& p) {
      p.incidents.erase(p.incidents.begin(),
                        p.incidents.begin() + static_cast<std::ptrdiff_t>(p.incidents.size() / 2));
    });
    with("the second half of the incidents", [](Plan& p) { p.incidents.resize(p.incidents.size() / 2); });
  }
  for (std::size_t i = 0; i < plan.incidents.size(); ++i)
    with("incident: " + describe(plan, plan.incidents[i]),
         [i](Plan& p) { p.incidents.erase(p.incidents.begin() + static_cast<std::ptrdiff_t>(i)); });
  const NetworkFaults& network = plan.network;
  if (network.lost > 0) with("loss", [](Plan& p) { p.network.lost = 0; });
  if (network.duplicated > 0) with("duplicates", [](Plan& p) { p.network.duplicated = 0; });
  if (network.late > 0) with("late messages", [](Plan& p) { p.network.late = 0; });
  if (network.truncated > 0) with("truncation", [](Plan& p) { p.network.truncated = 0; });
  if (network.flipped > 0) with("flipped bits", [](Plan& p) { p.network.flipped = 0; });
  if (network.jitter_us > 0) with("jitter", [](Plan& p) { p.network.jitter_us = 0; });
  if (network.delay_us > 0) with("delay", [](Plan& p) { p.network.delay_us = 0; });
  for (int i = 0; i < plan.hosts; ++i) {
    if (plan.clocks[i].drift_ppm != 0) with("drift of clocks", [i](Plan& p) { p.clocks[i].drift_ppm = 0; });
    if (plan.clocks[i].wall_off_us != 0) with("wrong dates", [i](Plan& p) { p.clocks[i].wall_off_us = 0; });
  }
  if (plan.hosts > 1) with("hosts", [](Plan& p) { p.hosts = 1; });
  if (plan.sensors > 2) with("sensors", [](Plan& p) { p.sensors = 2; });
  if (plan.global_always) with("--always", [](Plan& p) { p.global_always = false; });
  if (plan.fast_method != Method::sqp) with("slsqp", [](Plan& p) { p.fast_method = Method::sqp; });
  if (plan.global_method != Method::dual) with("sdp", [](Plan& p) { p.global_method = Method::dual; });
  if (plan.speed != 1) with("the player's speed", [](Plan& p) { p.speed = 1; });
  if (!plan.numbered) with("messages without numbers", [](Plan& p) { p.numbered = true; });
  return all;
}

std::string describe(const Plan& plan, const Incident& incident) {
  std::string text = name(incident.kind);
  if (incident.kind == IncidentKind::command)
    return text + " " + incident.text +
           (incident.amount == 0 ? " for all pairs" : " for pair " + std::to_string(incident.amount));
  if (incident.kind == IncidentKind::hostile || incident.kind == IncidentKind::flood ||
      incident.kind == IncidentKind::old_version)
    return text + ", " + std::to_string(incident.amount) + " datagrams, " + seconds(incident.duration_us);
  if (of_a_host(incident.kind))
    text += " host-" + std::to_string(incident.target % plan.hosts);
  else
    text += " " + process_name(plan, incident.target);
  switch (incident.kind) {
    case IncidentKind::kill:
      return text + (incident.amount == 0 ? ", idle" : ", at place " + std::to_string(incident.amount));
    case IncidentKind::end:
      return text;
    case IncidentKind::swap:
      return text + (incident.amount == 1 ? ", the new one first" : ", the old one ends first");
    case IncidentKind::twin:
      return text + " for " + seconds(incident.duration_us) + (incident.amount == 1 ? ", then killed" : "");
    case IncidentKind::set_date:
      return text + " by " + seconds(incident.amount);
    default:
      return text + " for " + seconds(incident.duration_us);
  }
}

std::string describe(const Plan& plan) {
  std::string text =
      std::to_string(plan.sensors) + " sensors at " + std::to_string(static_cast<int>(plan.rate_hz)) +
      " Hz, " + (plan.numbered ? "numbered" : "without numbers") + ", " +
      (plan.free_motion ? "free motion" : "rough ground") + ", " +
      (plan.input == Input::player ? "played at speed " + std::to_string(static_cast<int>(plan.speed))
                                   : "live") +
      ", " + std::to_string(plan.hosts) + " hosts, pairing " + (plan.state_file ? "with" : "without") +
      " a state file, solvers " + std::string(to_string(plan.fast_method)) + " and " +
      std::string(to_string(plan.global_method)) + (plan.global_always ? " --always" : "") +
      "\nfaults until " + seconds(plan.disturbed_us) + ", then quiet for " + seconds(plan.quiet_us) +
      "\nnetwork: delay " + seconds(plan.network.delay_us);
  const NetworkFaults& network = plan.network;
  if (network.jitter_us > 0) text += ", jitter " + seconds(network.jitter_us);
  if (network.lost > 0) text += ", lost " + percent(network.lost);
  if (network.duplicated > 0) text += ", duplicated " + percent(network.duplicated);
  if (network.late > 0) text += ", " + percent(network.late) + " late by " + seconds(network.late_by_us);
  if (network.truncated > 0) text += ", truncated " + percent(network.truncated);
  if (network.flipped > 0) text += ", one bit flipped in " + percent(network.flipped);
  text += "\n";
  for (int i = 0; i < plan.hosts; ++i)
    if (plan.clocks[i].drift_ppm != 0 || plan.clocks[i].wall_off_us != 0)
      text += "host-" + std::to_string(i) + ": date off by " + seconds(plan.clocks[i].wall_off_us) +
              ", clock drifts by " + std::to_string(plan.clocks[i].drift_ppm) + " ppm\n";
  for (const Incident& incident : plan.incidents)
    text += "at " + seconds(incident.at_us) + ": " + describe(plan, incident) + "\n";
  return text;
}

}  // namespace egocal::simulation
