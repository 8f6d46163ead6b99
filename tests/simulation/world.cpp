// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/world.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/decode.hpp"
#include "support/in_memory_file.hpp"

namespace egocal::simulation {

namespace {

/// Time for the last answers after the end of the player: as long as `egocal up` waits, and a timeout of a
/// heartbeat.
constexpr std::int64_t settle_us = 5'000'000;
/// Turns of processes while no time passes.
constexpr int most_turns_at_once = 100'000;

class World {
 public:
  World(const Plan& plan, const WorldOptions& options)
      : plan_(plan), options_(options), drive_(make_drive(plan)), random_(plan.seed * 3 + 2) {
    if (plan.input == Input::player) {
      file_.set(drive_.log.data(), drive_.log.size());
      log_ = file_.name();
    }
    for (int i = 0; i < plan.hosts; ++i)
      hosts_.push_back(std::make_unique<Host>(schedule_, i, plan.clocks[i]));
    network_ = std::make_unique<Network>(schedule_, hosts_, plan_);
    surroundings_ =
        std::make_unique<Surroundings>(Surroundings{plan_, drive_, log_, schedule_, hosts_, *network_});
    checks_ = std::make_unique<Checks>(*surroundings_, processes_);
    observe();
    add_processes();
    for (const Incident& incident : plan_.incidents)
      schedule_.after_us(incident.at_us, [this, &incident] { happens(incident); });
    schedule_.after_us(plan_.disturbed_us, [this] { calm_down(); });
  }

  Outcome run() {
    int turns = 0;
    std::int64_t at_ns = -1;
    while (!checks_->violation()) {
      Process* next = nullptr;
      for (const auto& process : processes_)
        if (process->runs() && (!next || process->wake_ns() < next->wake_ns())) next = process.get();
      const std::int64_t wake_ns = next ? std::max(next->wake_ns(), schedule_.now_ns()) : Schedule::never;
      const std::int64_t time_ns = std::min(wake_ns, schedule_.next_ns());
      if (time_ns > 1000 * end_us()) break;
      turns = time_ns == at_ns ? turns + 1 : 0;
      at_ns = time_ns;
      if (turns > most_turns_at_once) {
        checks_->fail('g', next->spec().name + " works on and on while no time passes");
        break;
      }
      schedule_.go_to(time_ns);
      if (schedule_.next_ns() <= wake_ns)
        schedule_.do_next();
      else
        ended(*next, next->turn());
      if (next) checks_->look_at_memory(*next);
    }
    if (!checks_->violation()) {
      schedule_.go_to(1000 * end_us());
      checks_->finish();
    }
    return {checks_->violation(),   trace_,
            schedule_.now_us(),     messages_,
            checks_->compared(),    checks_->certificates(),
            checks_->judged_good(), checks_->scales(),
            checks_->most_memory()};
  }

 private:
  /// End of the life; with a player it is known when the player ends.
  std::int64_t end_us() const {
    const std::int64_t data_us = plan_.disturbed_us + plan_.quiet_us;
    if (plan_.input == Input::live) return data_us + 2'000'000;
    return played_us_ >= 0 ? std::max(played_us_, plan_.disturbed_us) + settle_us : 4 * data_us + 60'000'000;
  }

  void trace(std::uint64_t kind, std::uint64_t a, std::uint64_t b) {
    trace_ = mixed(mixed(mixed(trace_ ^ kind, static_cast<std::uint64_t>(schedule_.now_ns())), a), b);
  }

  void tell(const std::string& line) const {
    if (!options_.tell) return;
    char time[32];
    std::snprintf(time, sizeof time, "%12.6f s  ", 1e-6 * static_cast<double>(schedule_.now_us()));
    options_.tell(time + line);
  }

  void observe() {
    network_->observe({[this](const Address& from, const std::string& channel, bus::Bytes message) {
                         ++messages_;
                         trace(1, from.port, hash_of(message.data(), message.size()));
                         if (options_.everything)
                           tell(process(from.process).spec().name + " sends " +
                                std::to_string(message.size()) + " bytes on " + channel);
                         checks_->sent(from, channel, message);
                       },
                       [this](const Address& to, const Packet& packet) { trace(2, to.port, packet.hash); },
                       [this](const Address& by, std::string_view channel, bus::Bytes message) {
                         checks_->received(by, channel, message);
                       }});
  }

  Process& process(int number) { return *processes_[static_cast<std::size_t>(number)]; }

  Process& add(ProcessSpec spec, std::int64_t start_us) {
    const int number = static_cast<int>(processes_.size());
    spec.host = std::min(spec.host, plan_.hosts - 1);
    processes_.push_back(std::make_unique<Process>(*surroundings_, std::move(spec), number));
    schedule_.after_us(start_us, [this, number] { start(process(number)); });
    return *processes_.back();
  }

  void add_processes() {
    const auto soon = [this] { return static_cast<std::int64_t>(random_.below(300'000)); };
    ProcessSpec pairing{.name = "egocal-pairing", .part = Part::pairing, .host = 0};
    if (plan_.state_file) pairing.state_file = "pairing.state";
    add(pairing, 0);
    add({.name = "egocal-fast", .part = Part::fast, .host = 1, .method = plan_.fast_method}, soon());
    add({.name = "egocal-global",
         .part = Part::global,
         .host = 1,
         .method = plan_.global_method,
         .always = plan_.global_always},
        soon());
    add({.name = "egocal-monitor", .part = Part::monitor, .host = 2}, soon());
    add({.name = "egocal-export", .part = Part::exporter, .host = 2}, soon());
    if (plan_.input == Input::player) {
      add({.name = "egocal-player", .part = Part::player, .host = 0}, soon());
    } else {
      for (int i = 0; i < plan_.sensors; ++i)
        add({.name = "odometry-" + std::to_string(i),
             .part = Part::odometry,
             .host = 0,
             .sensor = static_cast<std::size_t>(i)},
            0);
    }
    if (plan_.diagnosed) add({.name = "egocal-diagnosis", .part = Part::diagnosis, .host = 2}, soon());
  }

  void start(Process& process) {
    if (process.runs() || process.retired()) return;
    // what was started by hand on a host without power would be a fault after the faults
    if (!process.spec().supervised && schedule_.now_us() >= plan_.disturbed_us) return;
    if (hosts_[static_cast<std::size_t>(process.spec().host)]->down) {
      const int number = process.number();
      schedule_.after_us(50'000, [this, number] { start(this->process(number)); });
      return;
    }
    tell(process.spec().name + " starts");
    trace(3, static_cast<std::uint64_t>(process.number()), 0);
    checks_->started(process);
    ended(process, process.start());
  }

  void ended(Process& process, const std::optional<Process::Ending>& ending) {
    if (!ending) return;
    tell(process.spec().name + (ending->exit_code < 0
                                    ? " is killed"
                                    : " ends with exit code " + std::to_string(ending->exit_code) +
                                          (ending->error.empty() ? "" : ": " + ending->error)));
    trace(4, static_cast<std::uint64_t>(process.number()), static_cast<std::uint64_t>(ending->exit_code));
    checks_->ended(process, *ending);
    if (ending->next == tools::Restarts::Next::finished) {
      played_us_ = schedule_.now_us();
    } else if (process.spec().supervised) {
      const int number = process.number();
      schedule_.after_us(1000 * process.pause().count(), [this, number] { start(this->process(number)); });
    }
  }

  void happens(const Incident& incident);
  void add_twin(const Process& of, const Incident& incident);
  void swap(Process& old, const Incident& incident);
  void cut_power(int host, std::int64_t duration_us);
  void damage_something();
  void flood(std::int64_t count);
  void send_foreign();
  void go_back_to_state(std::int64_t by_us);
  void command(const std::string& to, const std::string& verb, std::int64_t pair);
  void calm_down();
  void resume();
  void watch_answers() {
    checks_->look_at_answers();
    schedule_.after_us(100'000, [this] { watch_answers(); });
  }

  const Plan plan_;
  const WorldOptions& options_;
  Drive drive_;
  testing::Random random_;
  test::InMemoryFile file_;
  std::string log_;
  Schedule schedule_;
  std::vector<std::unique_ptr<Host>> hosts_;
  std::unique_ptr<Network> network_;
  std::unique_ptr<Surroundings> surroundings_;
  std::vector<std::unique_ptr<Process>> processes_;
  std::unique_ptr<Checks> checks_;
  std::uint64_t trace_ = 0;
  std::int64_t messages_ = 0, played_us_ = -1;
};

void World::happens(const Incident& incident) {
  if (schedule_.now_us() >= plan_.disturbed_us) return;
  tell("-- " + describe(plan_, incident));
  const auto later = [&](auto action) { schedule_.after_us(incident.duration_us, action); };
  const int target = incident.target;
  const int host_number = std::max(0, target) % plan_.hosts;
  Host& host = *hosts_[static_cast<std::size_t>(host_number)];
  Process& victim = process(std::max(0, target) % processes(plan_));
  switch (incident.kind) {
    case IncidentKind::kill:
      if (incident.amount > 0) return victim.kill_at_place(incident.amount);
      victim.kill_at_place(incident.amount);
      return ended(victim, victim.kill());
    case IncidentKind::end:
      if (incident.amount > 0) victim.kill_at_place(incident.amount);
      ended(victim, victim.end());
      return;
    case IncidentKind::stop:
      victim.set_stopped(true);
      later([&victim] { victim.set_stopped(false); });
      return;
    case IncidentKind::away:
      network_->set_away(host_number, true);
      later([this, host_number] { network_->set_away(host_number, false); });
      return;
    case IncidentKind::partition:
      network_->set_partition(host_number, true);
      later([this, host_number] { network_->set_partition(host_number, false); });
      return;
    case IncidentKind::clog:
      network_->set_clogged_until(host_number,
                                  std::min(schedule_.now_us() + incident.duration_us, plan_.disturbed_us));
      return;
    case IncidentKind::set_date:
      host.clock.set_date(incident.amount);
      return;
    case IncidentKind::disk_full:
      host.disk.set_full(true);
      later([&host] { host.disk.set_full(false); });
      return;
    case IncidentKind::read_only:
      host.disk.set_read_only(true);
      later([&host] { host.disk.set_read_only(false); });
      return;
    case IncidentKind::slow_disk:
      host.disk.set_delay_us(incident.amount);
      later([&host] { host.disk.set_delay_us(0); });
      return;
    case IncidentKind::old_state:
      return go_back_to_state(incident.duration_us);
    case IncidentKind::foreign:
      for (std::int64_t i = 0; i < incident.amount; ++i)
        schedule_.after_us(
            static_cast<std::int64_t>(random_.below(static_cast<std::uint64_t>(incident.duration_us) + 1)),
            [this] { send_foreign(); });
      return;
    case IncidentKind::twin:
      return add_twin(victim, incident);
    case IncidentKind::power_cut:
      return cut_power(host_number, incident.duration_us);
    case IncidentKind::old_version: {
      ProcessSpec old{.name = "egocal-old", .part = Part::monitor, .host = host_number, .version = "0.0.1"};
      old.supervised = false;
      Process& process = add(old, 0);
      later([this, &process] { ended(process, process.end()); });
      return;
    }
    case IncidentKind::hostile:
      for (std::int64_t i = 0; i < incident.amount; ++i)
        schedule_.after_us(
            static_cast<std::int64_t>(random_.below(static_cast<std::uint64_t>(incident.duration_us) + 1)),
            [this] { damage_something(); });
      return;
    case IncidentKind::flood:
      return flood(incident.amount);
    case IncidentKind::swap:
      return swap(victim, incident);
    case IncidentKind::command:
      return command(target < 0 ? "*" : victim.spec().name, incident.text, incident.amount);
  }
}

/// Started by hand: ends by itself, and is not started again.
void World::add_twin(const Process& of, const Incident& incident) {
  ProcessSpec spec = of.spec();
  spec.supervised = false;
  if (!spec.state_file.empty()) spec.state_file = "twin-" + std::to_string(processes_.size()) + ".state";
  spec.host = static_cast<int>(random_.below(static_cast<std::uint64_t>(plan_.hosts)));
  Process& twin = add(spec, 0);
  const bool killed = incident.amount == 1;
  schedule_.after_us(incident.duration_us,
                     [this, &twin, killed] { ended(twin, killed ? twin.kill() : twin.end()); });
}

void World::swap(Process& old, const Incident& incident) {
  if (old.retired()) return;
  ProcessSpec spec = old.spec();
  spec.name += "-" + std::to_string(processes_.size());
  if (plan_.swaps_methods && spec.part == Part::fast)
    spec.method = spec.method == Method::sqp ? Method::slsqp : Method::sqp;
  else if (plan_.swaps_methods)
    spec.method = spec.method == Method::dual ? Method::sdp : Method::dual;
  const std::int64_t distance_us = std::min<std::int64_t>(incident.duration_us, 1'000'000);
  add(spec, incident.amount == 1 ? 0 : distance_us);
  old.retire();
  schedule_.after_us(incident.amount == 1 ? distance_us : 0, [this, &old] { ended(old, old.end()); });
}

void World::cut_power(int number, std::int64_t duration_us) {
  Host& host = *hosts_[static_cast<std::size_t>(number)];
  if (host.down) return;
  host.down = true;
  for (std::size_t i = 0; i < processes_.size(); ++i)
    if (processes_[i]->spec().host == number) ended(*processes_[i], processes_[i]->kill());
  host.disk.power_cut(random_);
  // the end of the faults is the end of the cut at the latest
  const std::int64_t left_us = plan_.disturbed_us - schedule_.now_us();
  schedule_.after_us(std::min(duration_us, left_us), [&host] {
    host.down = false;
    ++host.boots;
    host.clock.boot();
  });
}

void World::damage_something() {
  if (schedule_.now_us() >= plan_.disturbed_us) return;
  const PacketPtr original = network_->recent(random_);
  if (!original) return;
  Packet packet = *original;
  const std::uint64_t changes = 1 + random_.below(8);
  if (random_.below(4) == 0) packet.datagram.resize(random_.below(packet.datagram.size() + 64));
  for (std::uint64_t i = 0; i < changes && !packet.datagram.empty(); ++i)
    packet.datagram[random_.below(packet.datagram.size())] = std::byte(random_.below(256));
  network_->inject(std::move(packet));
}

void World::flood(std::int64_t count) {
  const PacketPtr original = network_->recent(random_);
  if (!original) return;
  for (std::int64_t i = 0; i < count; ++i) network_->inject(*original);
}

/// Another user of the group: its own channels and types, and now and then its types on our channels.
void World::send_foreign() {
  if (schedule_.now_us() >= plan_.disturbed_us) return;
  const bus::PairConfig& pair = drive_.rig.pairs.front();
  const std::string ours[] = {drive_.rig.sensors.front().channel, bus::problem_channel(pair.a, pair.b),
                              bus::calibration_channel(pair.a, pair.b), bus::status_channel,
                              bus::command_channel};
  const std::uint64_t choice = random_.below(2 * std::size(ours));
  const std::string channel = choice < std::size(ours) ? ours[choice] : "CAMERA_" + std::to_string(choice);
  std::vector<std::byte> message(8 + random_.below(3000));
  for (std::byte& byte : message) byte = std::byte(random_.below(256));
  network_->send_from_outside(channel, message);
}

/// A backup of the state is restored: later the file holds what it holds now.
void World::go_back_to_state(std::int64_t by_us) {
  Process& pairing = process(0);
  const std::string name = pairing.spec().state_file;
  Host& host = *hosts_[static_cast<std::size_t>(pairing.spec().host)];
  const std::shared_ptr<const Disk::File> now = name.empty() ? nullptr : host.disk.find(name);
  if (!now) return;
  schedule_.after_us(by_us, [this, &pairing, &host, name, backup = *now] {
    if (schedule_.now_us() >= plan_.disturbed_us) return;
    ended(pairing, pairing.kill());
    host.disk.restore(name, backup);
    tell("-- the state is that of a backup");
  });
}

void World::command(const std::string& to, const std::string& verb, std::int64_t pair) {
  command_t message{};
  message.utime = HostClock::start_of_all_us + schedule_.now_us();
  message.to = to;
  message.verb = verb;
  if (pair > 0) {
    const bus::PairConfig& config = drive_.rig.pairs[static_cast<std::size_t>(pair - 1)];
    message.sensor_a = config.a;
    message.sensor_b = config.b;
  }
  checks_->commanded(to, verb, message.sensor_a, message.sensor_b);
  network_->send_from_outside(bus::command_channel, bus::encode(message));
}

void World::calm_down() {
  tell("-- the faults are over");
  NetworkFaults calm;
  calm.delay_us = plan_.network.delay_us;
  network_->set_faults(calm);
  for (int i = 0; i < plan_.hosts; ++i) {
    network_->set_away(i, false);
    network_->set_partition(i, false);
    network_->set_clogged_until(i, 0);
    Disk& disk = hosts_[static_cast<std::size_t>(i)]->disk;
    disk.set_full(false);
    disk.set_read_only(false);
    disk.set_delay_us(0);
  }
  for (const auto& one : processes_) {
    one->set_stopped(false);
    one->kill_at_place(0);
    one->spare_next_life();
    if (!one->spec().supervised) ended(*one, one->end());
  }
  if (std::any_of(plan_.incidents.begin(), plan_.incidents.end(),
                  [](const Incident& incident) { return incident.kind == IncidentKind::command; }))
    resume();
  watch_answers();
}

/// Repeats the command, as a process that is not there when it comes stays paused.
void World::resume() {
  command("*", "resume", 0);
  if (schedule_.now_us() < plan_.disturbed_us + plan_.quiet_us / 2)
    schedule_.after_us(1'000'000, [this] { resume(); });
}

}  // namespace

Outcome live(const Plan& plan, const WorldOptions& options) {
  return World(plan, options).run();
}

}  // namespace egocal::simulation
