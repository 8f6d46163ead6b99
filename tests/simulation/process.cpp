// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/process.hpp"

#include <exception>
#include <utility>

#include "diagnosis/diagnosing.hpp"
#include "pairing/pairing.hpp"
#include "player/player.hpp"
#include "simulation/allocations.hpp"
#include "solving/fast.hpp"
#include "solving/global.hpp"

namespace egocal::simulation {

namespace {

bus::Role role_of(Part part) {
  switch (part) {
    case Part::player:
      return bus::Role::player;
    case Part::pairing:
      return bus::Role::pairing;
    case Part::fast:
      return bus::Role::fast;
    case Part::global:
      return bus::Role::global;
    case Part::diagnosis:
      return bus::Role::diagnosis;
    default:
      return bus::Role::monitor;
  }
}

/// Processes without a heartbeat.
bool is_silent(Part part) {
  return part == Part::odometry || part == Part::exporter;
}

}  // namespace

/// One life. Members end in reverse order, as those of a main().
struct Process::Instance {
  /// The clock of the host. The time that the disk takes within a turn passes in that turn.
  class OwnClock final : public bus::Clock {
   public:
    explicit OwnClock(const Host& host) : host_(host) {}
    std::int64_t mono_ns() const override { return host_.clock.mono_ns() + 1000 * host_.disk.waited_us(); }
    std::int64_t wall_us() const override { return host_.clock.wall_us() + host_.disk.waited_us(); }
    int wait(std::span<pollfd>, std::chrono::nanoseconds) const override { return 0; }

   private:
    const Host& host_;
  };

  explicit Instance(const Host& host) : clock(host) {}

  OwnClock clock;
  Life life;
  std::unique_ptr<bus::Loop> loop;
  std::unique_ptr<bus::Heartbeat> heartbeat;
  std::unique_ptr<services::Pairing> pairing;
  std::unique_ptr<services::FastSolver> fast;
  std::unique_ptr<services::GlobalSolver> global;
  std::unique_ptr<services::Player> player;
  std::unique_ptr<Odometry> odometry;
  std::unique_ptr<Watcher> watcher;
  std::unique_ptr<Exporter> exporter;
  std::unique_ptr<services::Diagnosing> diagnosing;
};

Process::Process(const Surroundings& surroundings, ProcessSpec spec, int number)
    : surroundings_(surroundings), spec_(std::move(spec)), restarts_({}), number_(number) {}

Process::~Process() {
  if (instance_) instance_->life.end();
}

const Watcher* Process::watcher() const {
  return instance_ ? instance_->watcher.get() : nullptr;
}

const Exporter* Process::exporter() const {
  return instance_ ? instance_->exporter.get() : nullptr;
}

void Process::make_service() {
  Instance& i = *instance_;
  const bus::Rig& rig = surroundings_.drive.rig;
  Host& host = *surroundings_.hosts[static_cast<std::size_t>(spec_.host)];
  switch (spec_.part) {
    case Part::player: {
      services::PlayerOptions options;
      options.log = surroundings_.log;
      options.speed = surroundings_.plan.speed;
      i.player = std::make_unique<services::Player>(*i.loop, *i.heartbeat, options);
      return;
    }
    case Part::odometry:
      i.odometry =
          std::make_unique<Odometry>(*i.loop, surroundings_.schedule, surroundings_.drive, spec_.sensor);
      return;
    case Part::pairing: {
      std::unique_ptr<services::SavedState> saved;
      if (!spec_.state_file.empty())
        saved = std::make_unique<services::SavedState>(
            host.disk.open(spec_.state_file, i.life, static_cast<std::uint64_t>(lives_)), rig,
            [&host] { return host.boot_time(); });
      i.pairing = std::make_unique<services::Pairing>(*i.loop, *i.heartbeat, rig, std::move(saved));
      return;
    }
    case Part::fast:
      i.fast = std::make_unique<services::FastSolver>(*i.loop, *i.heartbeat, rig, spec_.method);
      return;
    case Part::global:
      i.global =
          std::make_unique<services::GlobalSolver>(*i.loop, *i.heartbeat, rig, spec_.method, spec_.always);
      return;
    case Part::monitor:
      i.watcher = std::make_unique<Watcher>(*i.loop, *i.heartbeat, rig);
      return;
    case Part::exporter:
      i.exporter = std::make_unique<Exporter>(*i.loop, rig);
      return;
    case Part::diagnosis:
      i.diagnosing = std::make_unique<services::Diagnosing>(*i.loop, *i.heartbeat, rig);
      return;
  }
}

std::optional<Process::Ending> Process::start() {
  const MemoryOwner owner(memory_owner());
  Host& host = *surroundings_.hosts[static_cast<std::size_t>(spec_.host)];
  ++lives_;
  started_us_ = surroundings_.schedule.now_us();
  instance_ = std::make_unique<Instance>(host);
  instance_->life.kill_at_place(std::exchange(kill_next_at_, 0));
  try {
    instance_->loop = std::make_unique<bus::Loop>(
        surroundings_.network.open({number_, spec_.host, port()}, instance_->life, [this] { wake(); }),
        instance_->clock,
        bus::LoopOptions{.handle_signals = false, .require_network = false, .host = host.name});
    if (!is_silent(spec_.part)) {
      const std::chrono::duration<double> timeout(surroundings_.drive.rig.heartbeat_timeout);
      instance_->heartbeat = std::make_unique<bus::Heartbeat>(
          *instance_->loop,
          bus::Identity{spec_.name, role_of(spec_.part), spec_.version, static_cast<std::int32_t>(port())},
          std::chrono::duration_cast<std::chrono::nanoseconds>(timeout));
    }
    make_service();
  } catch (const Killed&) {
    return over(-1, "");
  } catch (const std::exception& error) {
    return over(1, error.what());
  }
  wake();
  busy_until_ns_ = surroundings_.schedule.now_ns() + waited_ns();
  return std::nullopt;
}

/// For the disk, since the last call. A clock that is slow by up to 1000 ppm shows as much time then as it
/// did while the disk was busy.
std::int64_t Process::waited_ns() const {
  const std::int64_t us = disk().take_waited_us();
  return 1000 * us + 2 * us;
}

Disk& Process::disk() const {
  return surroundings_.hosts[static_cast<std::size_t>(spec_.host)]->disk;
}

std::optional<Process::Ending> Process::turn() {
  const MemoryOwner owner(memory_owner());
  bus::Loop& loop = *instance_->loop;
  bool goes_on = true;
  try {
    goes_on = loop.run_once(std::chrono::nanoseconds{0});
  } catch (const Killed&) {
    return over(-1, "");
  } catch (const std::exception& error) {
    return over(1, error.what());
  }
  if (!goes_on) return end();
  const std::optional<std::int64_t> due = loop.next_timer_ns();
  const Host& host = *surroundings_.hosts[static_cast<std::size_t>(spec_.host)];
  wake_ns_ = due ? host.clock.schedule_ns(*due) : Schedule::never;
  busy_until_ns_ = surroundings_.schedule.now_ns() + 1000 * burden_us() + waited_ns();
  return std::nullopt;
}

std::int64_t Process::burden_us() const {
  switch (spec_.part) {
    case Part::fast:
    case Part::global:
      return surroundings_.plan.burden.solvers_us;
    case Part::monitor:
    case Part::exporter:
    case Part::diagnosis:
      return surroundings_.plan.burden.listeners_us;
    default:
      return 0;
  }
}

std::optional<Process::Ending> Process::kill() {
  if (!instance_) return std::nullopt;
  return over(-1, "");
}

std::optional<Process::Ending> Process::end() {
  if (!instance_) return std::nullopt;
  const MemoryOwner owner(memory_owner());
  try {
    instance_->life.begin_to_end();
    if (instance_->heartbeat) instance_->heartbeat->end();
    instance_->pairing.reset();
    if (instance_->life.over()) return over(-1, "");
  } catch (const std::exception& error) {
    return over(1, error.what());
  }
  return over(0, "");
}

void Process::kill_at_place(std::int64_t count) {
  if (count < 0)
    kill_next_at_ = -count;
  else if (instance_)
    instance_->life.kill_at_place(count);
}

Process::Ending Process::over(int exit_code, const std::string& error) {
  instance_->life.end();
  instance_.reset();
  disk().take_waited_us();
  wake_ns_ = Schedule::never;
  busy_until_ns_ = 0;
  stopped_ = false;
  const std::chrono::milliseconds lived((surroundings_.schedule.now_us() - started_us_) / 1000);
  tools::Program program;
  program.name = spec_.name;
  program.ends_all = spec_.part == Part::player;
  return {exit_code, error, restarts_.ended(program, exit_code, lived)};
}

}  // namespace egocal::simulation
