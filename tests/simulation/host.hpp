// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "egocal/bus/clock.hpp"
#include "simulation/disk.hpp"
#include "simulation/plan.hpp"
#include "simulation/schedule.hpp"
#include "state/state_age.hpp"

namespace egocal::simulation {

/// The clocks of one simulated host: they drift, restart at a boot, and the date may be set.
class HostClock final : public bus::Clock {
 public:
  HostClock(const Schedule& schedule, const ClockFaults& faults)
      : schedule_(schedule), drift_ppm_(faults.drift_ppm), wall_off_us_(faults.wall_off_us) {}

  std::int64_t mono_ns() const override { return first_ns + passed_ns() - boot_ns_; }
  std::int64_t wall_us() const override { return start_of_all_us + passed_ns() / 1000 + wall_off_us_; }
  int wait(std::span<pollfd>, std::chrono::nanoseconds) const override { return 0; }

  /// The first time of the schedule at which this clock shows at least this time.
  std::int64_t schedule_ns(std::int64_t mono) const {
    const std::int64_t passed = mono - first_ns + boot_ns_;
    std::int64_t time = passed - passed / 1'000'000 * drift_ppm_ - 2000;
    while (drifted(time) < passed) time += std::max<std::int64_t>(1, (passed - drifted(time)) / 2);
    return time;
  }
  void boot() { boot_ns_ = passed_ns(); }
  void set_date(std::int64_t step_us) { wall_off_us_ += step_us; }

  static constexpr std::int64_t start_of_all_us = 1'700'000'000'000'000;

 private:
  static constexpr std::int64_t first_ns = 20'000'000'000;
  std::int64_t drifted(std::int64_t time_ns) const { return time_ns + time_ns / 1'000'000 * drift_ppm_; }
  std::int64_t passed_ns() const { return drifted(schedule_.now_ns()); }

  const Schedule& schedule_;
  std::int64_t drift_ppm_;
  std::int64_t wall_off_us_;
  std::int64_t boot_ns_ = 0;
};

struct Host {
  Host(const Schedule& schedule, int number, const ClockFaults& faults)
      : name("host-" + std::to_string(number)), clock(schedule, faults), disk(clock) {}
  services::BootTime boot_time() const { return {name + " boot " + std::to_string(boots), clock.mono_us()}; }

  std::string name;
  HostClock clock;
  Disk disk;
  int boots = 1;
  bool down = false;  ///< without power
};

}  // namespace egocal::simulation
