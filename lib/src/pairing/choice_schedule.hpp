// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// When the pairs of one rig choose their weights.
#pragma once

#include <cstdint>

namespace egocal::detail {

/// By how many instants a choice is delayed that would be due at `next`, where another one follows after next
/// / part more. phase: AccumulatorOptions::choice_phase.
inline std::uint64_t choice_delay(std::uint64_t next, std::uint64_t part, double phase) {
  const std::uint64_t between = next / part;
  return static_cast<std::uint64_t>(phase * static_cast<double>(between));
}

}  // namespace egocal::detail
