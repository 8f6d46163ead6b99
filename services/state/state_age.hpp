// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace egocal::services {

/// Time by a clock that cannot be set: the time since the boot of the machine [us], and which boot that was.
/// It also counts while the machine sleeps.
struct BootTime {
  std::string boot;  ///< the kernel's name of this start; empty: unknown
  std::int64_t us = 0;
};
BootTime boot_time();

/// Age of a file [s]: the smaller of the age by boot times and the age by the time stamp of the file. The
/// first one is right when the wall clock was set meanwhile; the second one lets the user `touch` the file.
/// After a reboot only the time stamp counts.
std::int64_t age_s(const BootTime& written, const BootTime& now, std::int64_t file_time_s,
                   std::int64_t now_s);

}  // namespace egocal::services
