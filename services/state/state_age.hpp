// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace egocal::services {

/// When something was written, by a clock that cannot be set: the time since the machine's start [us], and
/// which start that was. It counts on while the machine sleeps.
struct BootTime {
  std::string boot;  ///< the kernel's name of this start; empty: unknown
  std::int64_t us = 0;
};
BootTime boot_time();

/// Age of a file [s]: by the boot times of its writing and of now, or by the file's own time, whichever is
/// younger. The first is right when the wall clock was set meanwhile, the second lets a person `touch` the
/// file. Written since another start of the machine: by the file's own time alone.
std::int64_t age_s(const BootTime& written, const BootTime& now, std::int64_t file_time_s,
                   std::int64_t now_s);

}  // namespace egocal::services
