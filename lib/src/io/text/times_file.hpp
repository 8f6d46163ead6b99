// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace egocal::detail {

/// The times of poses in another file, one a line [us]: seconds, nanoseconds since 1970, or a date and time
/// as the raw recordings of KITTI have it. Throws Error naming file and line.
std::vector<std::int64_t> read_times_file(const std::string& file);

}  // namespace egocal::detail
