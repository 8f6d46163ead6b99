// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "egocal/pairing/stream.hpp"

namespace egocal::services {

void add(const StreamCounts& counts, StreamCounts& sum);

/// The counts by the names that a process's status has for them.
std::map<std::string, std::int64_t> named(const StreamCounts& counts);

}  // namespace egocal::services
