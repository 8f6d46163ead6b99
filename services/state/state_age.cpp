// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "state/state_age.hpp"

#include <cstdlib>
#include <ctime>
#include <fstream>

namespace egocal::services {

BootTime boot_time() {
  static const std::string boot = [] {
    std::string name;
    std::ifstream stream("/proc/sys/kernel/random/boot_id");
    std::getline(stream, name);
    return name;
  }();
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return {boot, std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000};
}

std::int64_t age_s(const BootTime& written, const BootTime& now, std::int64_t file_time_s,
                   std::int64_t now_s) {
  const std::int64_t by_file = now_s - file_time_s;
  if (written.boot.empty() || written.boot != now.boot || written.us > now.us) return by_file;
  const std::int64_t by_boot = (now.us - written.us) / 1'000'000;
  return std::abs(by_file) < by_boot ? by_file : by_boot;
}

}  // namespace egocal::services
