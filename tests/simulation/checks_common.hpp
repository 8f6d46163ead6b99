// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>

#include "egocal/bus/bytes.hpp"
#include "simulation/plan.hpp"

namespace egocal::simulation {

/// After the faults, of data time.
constexpr std::int64_t recovery_us = 5'000'000;
/// StreamOptions::largest_jump.
constexpr std::int64_t largest_jump_us = 1'000'000;

/// Problems, answers and verdicts begin alike: eight bytes each, big endian; 0 where the message ends before.
enum Field : std::size_t { utime_at = 8, session_at = 16, seq_at = 24 };
inline std::int64_t field(bus::Bytes message, std::size_t at) {
  return message.size() < at + 8 ? 0 : static_cast<std::int64_t>(bus::big_endian<std::uint64_t>(message, at));
}

inline bool has(const Plan& plan, std::initializer_list<IncidentKind> kinds) {
  return std::any_of(plan.incidents.begin(), plan.incidents.end(), [&](const Incident& incident) {
    return std::find(kinds.begin(), kinds.end(), incident.kind) != kinds.end();
  });
}

}  // namespace egocal::simulation
