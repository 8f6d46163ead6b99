// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/plan.hpp"

#include <algorithm>
#include <cstdio>

#include "support/mistakes.hpp"
#include "support/random_motion.hpp"

namespace egocal::simulation {

namespace {

using testing::Random;

constexpr const char* names[incident_kinds] = {
    "kill",           "stop",      "end",         "twin",    "away",  "partition", "clog",    "set the date",
    "disk full",      "power cut", "old version", "hostile", "flood", "swap",      "command", "foreign",
    "disk read-only", "slow disk", "old state"};

constexpr const char* estimations[] = {"plain", "robust", "automatic"};

/// Seeds in this range are short runs: two sensors at 4 Hz, at most 5 s of faults, the cheapest estimation
/// and solvers. They find the same orders of events in half the time.
constexpr std::uint64_t first_short_seed = 10'000'000, last_short_seed = 999'999'999;

/// Number of the first process that sends odometry.
constexpr int first_input = 5;

/// testing::mistakes(), without the one at 0 that is none, those of rows, and the one before these.
const int most_mistakes = static_cast<int>(testing::mistakes().size() - testing::mistakes_of_rows) - 2;

bool of_a_host(IncidentKind kind) {
  switch (kind) {
    case IncidentKind::away:
    case IncidentKind::partition:
    case IncidentKind::clog:
    case IncidentKind::set_date:
    case IncidentKind::disk_full:
    case IncidentKind::power_cut:
    case IncidentKind::read_only:
    case IncidentKind::slow_disk:
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
  return first_input + (plan.input == Input::player ? 1 : plan.sensors) + (plan.diagnosed ? 1 : 0);
}

std::string process_name(const Plan& plan, int number) {
  static const std::string fixed[first_input] = {"egocal-pairing", "egocal-fast", "egocal-global",
                                                 "egocal-monitor", "egocal-export"};
  if (number < first_input) return fixed[number];
  if (plan.diagnosed && number == processes(plan) - 1) return "egocal-diagnosis";
  return plan.input == Input::player ? "egocal-player" : "odometry-" + std::to_string(number - first_input);
}

const char* name(IncidentKind kind) {
  return names[static_cast<int>(kind)];
}

namespace {

/// Short and cheap in most lives: what a life finds are orders of events, and those cost nothing. Some lives
/// have all that costs.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed), later_(seed ^ 0x6a09e667f3bcc908) {
    random_.bits();
    later_.bits();
    plan_.seed = seed;
  }

  Plan plan() {
    drive();
    programs();
    network();
    if (chance(0.3)) clocks();
    if (plan_.seed >= first_short_seed && plan_.seed <= last_short_seed) shorten();
    incidents();
    if (plan_.input == Input::player && chance(0.03))
      play_again();
    else
      later_faults();
    return std::move(plan_);
  }

 private:
  bool chance(double share) { return random_.uniform() < share; }
  std::int64_t between(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random_.below(static_cast<std::uint64_t>(high - low)));
  }
  std::int64_t log_between(double low, double high) {
    return static_cast<std::int64_t>(random_.log_uniform(low, high));
  }

  void drive() {
    plan_.sensors = chance(0.85) ? 2 : chance(0.7) ? 3 : static_cast<int>(between(4, 6));
    plan_.rate_hz = chance(0.8) ? 4 : chance(0.8) ? 10 : 20;
    plan_.disturbed_us = chance(0.95) ? between(1'500'000, 5'000'000) : between(5'000'000, 20'000'000);
    plan_.quiet_us = 6'000'000;
    plan_.free_motion = chance(0.7);
    plan_.numbered = chance(0.8);
    plan_.estimation = chance(0.85)   ? Estimation::plain
                       : chance(0.85) ? Estimation::robust
                                      : Estimation::automatic;
    plan_.input = chance(0.5) ? Input::player : Input::live;
    plan_.speed = chance(0.7) ? 1 : chance(0.5) ? 3 : 0;
    if (!chance(0.003)) return;
    plan_.diagnosed = true;
    plan_.estimation = Estimation::automatic;
    plan_.rate_hz = 10;
    if (chance(0.5)) plan_.mistake = static_cast<int>(between(1, most_mistakes + 1));
  }

  /// Without what costs much: the orders of events stay.
  void shorten() {
    plan_.sensors = 2;
    plan_.rate_hz = 4;
    plan_.disturbed_us = std::min<std::int64_t>(plan_.disturbed_us, 5'000'000);
    plan_.estimation = Estimation::plain;
    plan_.diagnosed = false;
    plan_.mistake = 0;
    plan_.fast_method = Method::sqp;
    plan_.global_method = Method::dual;
    plan_.swaps_methods = false;
  }

  void programs() {
    plan_.state_file = chance(0.8);
    plan_.hosts = chance(0.5) ? 1 : static_cast<int>(between(2, most_hosts + 1));
    plan_.fast_method = chance(0.9) ? Method::sqp : Method::slsqp;
    plan_.global_method = chance(0.9) ? Method::dual : Method::sdp;
    plan_.global_always = chance(0.1);
    if (chance(0.7)) plan_.burden = {between(0, 300'000), between(0, 300'000)};
  }

  void network() {
    NetworkFaults& network = plan_.network;
    network.delay_us = chance(0.5) ? 0 : between(10, 2000);
    if (chance(0.3)) network.lost = random_.log_uniform(0.001, 0.3);
    if (chance(0.3)) network.duplicated = random_.log_uniform(0.001, 0.3);
    if (chance(0.3)) network.jitter_us = log_between(10, 200'000);
    if (chance(0.2)) {
      network.late = random_.log_uniform(0.001, 0.1);
      network.late_by_us = log_between(1000, 1'000'000);
    }
    // a log at full speed is over before anything late arrives: what overtakes seconds of it begins it again
    if (plan_.input == Input::player && plan_.speed == 0) network.jitter_us = 0, network.late = 0;
    if (chance(0.07)) network.truncated = random_.log_uniform(0.0005, 0.05);
    if (chance(0.07)) network.flipped = random_.log_uniform(0.0005, 0.05);
  }

  void clocks() {
    for (ClockFaults& clock : plan_.clocks) {
      clock.wall_off_us = chance(0.5) ? between(-10'000'000, 10'000'000) : 0;
      clock.drift_ppm = static_cast<int>(between(-200, 201));
    }
  }

  /// Which kinds there are in this life, and how often each.
  void incidents() {
    for (int k = 0; k <= static_cast<int>(IncidentKind::command); ++k) {
      const auto kind = static_cast<IncidentKind>(k);
      // in few lives: little is promised then
      const bool alters = kind == IncidentKind::hostile || kind == IncidentKind::flood ||
                          kind == IncidentKind::command || kind == IncidentKind::power_cut;
      if (!chance(alters ? 0.06 : 0.2)) continue;
      const std::int64_t count = between(1, 4);
      for (std::int64_t i = 0; i < count; ++i) plan_.incidents.push_back(incident(kind));
    }
    sort_incidents();
  }
  void sort_incidents() {
    std::stable_sort(plan_.incidents.begin(), plan_.incidents.end(),
                     [](const Incident& x, const Incident& y) { return x.at_us < y.at_us; });
  }

  /// Faults that joined later have random numbers of their own: most seeds still mean what they meant.
  void later_faults() {
    std::swap(random_, later_);
    if (chance(0.05)) {
      plan_.network.burst = random_.log_uniform(0.001, 0.02);
      plan_.network.burst_length = static_cast<int>(log_between(2, 100));
    }
    if (!plan_.diagnosed) {
      if (chance(0.05)) plan_.bump_s = 1e-6 * static_cast<double>(between(500'000, plan_.disturbed_us));
      if (chance(0.05)) plan_.scale = random_.log_uniform(0.5, 2);
      if (chance(0.05)) plan_.clock_drift = random_.uniform(-1e-3, 1e-3);
    }
    for (const IncidentKind kind :
         {IncidentKind::foreign, IncidentKind::read_only, IncidentKind::slow_disk, IncidentKind::old_state})
      if (chance(0.05)) plan_.incidents.push_back(incident(kind));
    sort_incidents();
    if (!plan_.diagnosed && chance(0.02)) {
      plan_.auto_scale = true;
      if (plan_.estimation == Estimation::robust)
        plan_.estimation = Estimation::plain;  // no stride is chosen
      if (plan_.scale == 1) plan_.scale = random_.log_uniform(0.5, 2);
      plan_.bump_s = plan_.clock_drift = 0;
      plan_.quiet_us = 18'000'000;  // the first scale takes 13 s
    }
  }

  /// The player dies late in its log and begins again, before all that pairing knows again.
  void play_again() {
    plan_.rate_hz = 20;
    plan_.speed = 1;
    plan_.disturbed_us = between(6'000'000, 9'000'000);
    Incident kill;
    kill.kind = IncidentKind::kill;
    kill.target = first_input;
    kill.at_us = between(plan_.disturbed_us * 9 / 10, plan_.disturbed_us);
    plan_.incidents = {kill};
  }

  Incident incident(IncidentKind kind) {
    Incident incident;
    incident.kind = kind;
    incident.at_us = between(0, plan_.disturbed_us);
    incident.target = static_cast<int>(between(0, of_a_host(kind) ? plan_.hosts : processes(plan_)));
    incident.duration_us = log_between(10'000, 5'000'000);
    switch (kind) {
      case IncidentKind::end:
        // a person who ends the player wants no more of the log
        if (incident.target == first_input) incident.target = 0;
        if (chance(0.3)) incident.amount = between(1, 4);
        break;
      case IncidentKind::kill:
        if (chance(0.5)) incident.target = 0;  // the one with a state
        incident.amount = chance(0.3) ? 0 : chance(0.3) ? -between(1, 6) : between(1, 20);
        break;
      case IncidentKind::set_date:
        incident.amount =
            chance(0.5) ? between(-5'000'000, 5'000'000) : between(-86'400'000'000, 86'400'000'000);
        break;
      case IncidentKind::twin:
        incident.target = chance(0.6) ? 0 : static_cast<int>(between(1, 3));
        incident.amount = between(0, 2);
        break;
      case IncidentKind::swap:
        incident.target = static_cast<int>(between(1, 3));
        incident.amount = between(0, 2);
        break;
      case IncidentKind::hostile:
      case IncidentKind::flood:
      case IncidentKind::foreign:
        incident.amount = log_between(1, 1000);
        break;
      case IncidentKind::slow_disk:
        incident.amount = log_between(1000, 500'000);
        break;
      case IncidentKind::command:
        incident.text = chance(0.5) ? "reset" : chance(0.5) ? "pause" : "resume";
        incident.amount = between(0, plan_.sensors);
        incident.target = chance(0.6) ? 0 : static_cast<int>(between(-1, 3));
        break;
      default:
        break;
    }
    return incident;
  }

  Random random_, later_;
  Plan plan_;
};

}  // namespace

Plan draw(std::uint64_t seed) {
  return Draw(seed).plan();
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
  if (network.burst > 0) with("bursts of loss", [](Plan& p) { p.network.burst = 0; });
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
  if (plan.burden.solvers_us > 0) with("slow solvers", [](Plan& p) { p.burden.solvers_us = 0; });
  if (plan.burden.listeners_us > 0) with("slow listeners", [](Plan& p) { p.burden.listeners_us = 0; });
  if (plan.estimation != Estimation::plain)
    with("choices of the estimation", [](Plan& p) { p.estimation = Estimation::plain; });
  if (plan.diagnosed && plan.mistake == 0) with("diagnosis", [](Plan& p) { p.diagnosed = false; });
  if (plan.bump_s > 0) with("the bump", [](Plan& p) { p.bump_s = 0; });
  if (plan.auto_scale) with("the unknown scale", [](Plan& p) { p.auto_scale = false; });
  if (plan.scale != 1) with("the scale", [](Plan& p) { p.scale = 1; });
  if (plan.clock_drift != 0) with("the sensor's clock drift", [](Plan& p) { p.clock_drift = 0; });
  if (plan.hosts > 1) with("hosts", [](Plan& p) { p.hosts = 1; });
  if (plan.sensors > 2) with("sensors", [](Plan& p) { p.sensors = 2; });
  if (plan.global_always) with("--always", [](Plan& p) { p.global_always = false; });
  if (plan.fast_method != Method::sqp) with("slsqp", [](Plan& p) { p.fast_method = Method::sqp; });
  if (plan.swaps_methods) with("other methods", [](Plan& p) { p.swaps_methods = false; });
  if (plan.global_method != Method::dual) with("sdp", [](Plan& p) { p.global_method = Method::dual; });
  if (plan.speed != 1) with("the player's speed", [](Plan& p) { p.speed = 1; });
  if (!plan.numbered) with("messages without numbers", [](Plan& p) { p.numbered = true; });
  return all;
}

std::string describe(const Plan& plan, const Incident& incident) {
  std::string text = name(incident.kind);
  if (incident.kind == IncidentKind::command)
    return text + " " + incident.text + " to " +
           (incident.target < 0 ? "all" : process_name(plan, incident.target)) +
           (incident.amount == 0 ? " for all pairs" : " for pair " + std::to_string(incident.amount));
  if (incident.kind == IncidentKind::hostile || incident.kind == IncidentKind::flood ||
      incident.kind == IncidentKind::foreign || incident.kind == IncidentKind::old_version)
    return text + ", " + std::to_string(incident.amount) + " datagrams, " + seconds(incident.duration_us);
  if (of_a_host(incident.kind))
    text += " host-" + std::to_string(incident.target % plan.hosts);
  else
    text += " " + process_name(plan, incident.target);
  switch (incident.kind) {
    case IncidentKind::kill:
      return text + (incident.amount == 0 ? ", idle"
                     : incident.amount < 0
                         ? ", at place " + std::to_string(-incident.amount) + " of its next life"
                         : ", at place " + std::to_string(incident.amount));
    case IncidentKind::end:
      return text + (incident.amount == 0 ? "" : ", killed at place " + std::to_string(incident.amount));
    case IncidentKind::swap:
      return text + (incident.amount == 1 ? ", the new one first" : ", the old one ends first");
    case IncidentKind::twin:
      return text + " for " + seconds(incident.duration_us) + (incident.amount == 1 ? ", then killed" : "");
    case IncidentKind::set_date:
      return text + " by " + seconds(incident.amount);
    case IncidentKind::slow_disk:
      return text + " for " + seconds(incident.duration_us) + ", " + seconds(incident.amount) + " a write";
    case IncidentKind::old_state:
      return text + ", from " + seconds(incident.duration_us) + " before";
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
      std::string(to_string(plan.global_method)) + (plan.global_always ? " --always" : "") + ", " +
      estimations[static_cast<int>(plan.estimation)] + " estimation" + (plan.diagnosed ? ", diagnosed" : "") +
      (plan.mistake > 0 ? ", " + testing::mistakes()[static_cast<std::size_t>(plan.mistake)].name : "") +
      "\nfaults until " + seconds(plan.disturbed_us) + ", then quiet for " + seconds(plan.quiet_us) +
      "\nnetwork: delay " + seconds(plan.network.delay_us);
  if (plan.bump_s > 0 || plan.scale != 1 || plan.clock_drift != 0 || plan.auto_scale) {
    char drive[120];
    std::snprintf(drive, sizeof drive,
                  "\nthe second sensor: bump at %.6g s (0: none), scale %.6g, clock drift %.6g", plan.bump_s,
                  plan.scale, plan.clock_drift);
    text += drive;
    if (plan.auto_scale) text += ", to be found";
  }
  const NetworkFaults& network = plan.network;
  if (network.jitter_us > 0) text += ", jitter " + seconds(network.jitter_us);
  if (network.lost > 0) text += ", lost " + percent(network.lost);
  if (network.burst > 0)
    text += ", bursts of " + std::to_string(network.burst_length) + " lost from " + percent(network.burst) +
            " on";
  if (network.duplicated > 0) text += ", duplicated " + percent(network.duplicated);
  if (network.late > 0) text += ", " + percent(network.late) + " late by " + seconds(network.late_by_us);
  if (network.truncated > 0) text += ", truncated " + percent(network.truncated);
  if (network.flipped > 0) text += ", one bit flipped in " + percent(network.flipped);
  text += "\n";
  if (plan.burden.solvers_us > 0 || plan.burden.listeners_us > 0)
    text += "a turn of a solver takes " + seconds(plan.burden.solvers_us) + ", of a listener " +
            seconds(plan.burden.listeners_us) + "\n";
  for (int i = 0; i < plan.hosts; ++i)
    if (plan.clocks[i].drift_ppm != 0 || plan.clocks[i].wall_off_us != 0)
      text += "host-" + std::to_string(i) + ": date off by " + seconds(plan.clocks[i].wall_off_us) +
              ", clock drifts by " + std::to_string(plan.clocks[i].drift_ppm) + " ppm\n";
  for (const Incident& incident : plan.incidents)
    text += "at " + seconds(incident.at_us) + ": " + describe(plan, incident) + "\n";
  return text;
}

}  // namespace egocal::simulation
