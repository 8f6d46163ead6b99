// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the scale of b in a long drive is found from: a bounded number of motions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "diagnosis/motions/motions.hpp"
#include "egocal/pairing/options.hpp"
#include "egocal/scale/solve_scale.hpp"

namespace egocal::detail {

/// Limits on time and memory. Study: docs/benchmarks.md, "Drives with a mistake".
struct LongDriveOptions {
  /// A drive of more instants is looked at through this many motions, evenly spread: as many as the search
  /// for a mount that moved looks at (MountCheckOptions::most_motions).
  std::size_t most = 20'000;
  double motion = 1;  ///< length of the motions [s], as in ScaleCourseOptions
};

/// Whether the drive has more instants than are looked at.
bool is_long(const Instants& instants, const LongDriveOptions& options = {});

/// Motions of a long drive, none screened, in the order of time; in planar mode as seen from the planes, that
/// of b through its origin (find_scale_course()). origin_us: time of the first pose of a.
std::vector<MotionPair> spread_motions(const Instants& instants, std::int64_t origin_us,
                                       const PairingOptions& pairing, const MotionSampleOptions& motions,
                                       const LongDriveOptions& options = {});

/// The scale of b that the motions show, with weights by their noise. Empty where there are none.
std::optional<ScaleSolution> scale_of_b(std::span<const MotionPair> motions, Mode mode);

}  // namespace egocal::detail
