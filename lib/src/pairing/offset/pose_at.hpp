// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "egocal/pairing/options.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// Pose at a time [us] relative to `at_us`, interpolated as in pairing; empty: not known. `from`: index to
/// search from; it is moved forwards.
std::optional<DualQuaternion> pose_at(const Trajectory& trajectory, std::int64_t at_us, double time_us,
                                      double max_gap_us, std::size_t& from,
                                      const SynchroniserOptions& options = {});

/// Index of the pose from which to look for a time.
std::size_t first_before(const Trajectory& trajectory, std::int64_t at_us, double time_us);

}  // namespace egocal::detail
