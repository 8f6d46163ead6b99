// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions, or rotations, that never change in either stream, as of two attitude sensors whose poses were
// filled up with zeros. The motions then agree about the mounting without an error, and hold nothing of it.
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "diagnosis/streams/assumed.hpp"

namespace egocal::detail {

struct MissingInBothOptions {
  std::size_t least = 20;  ///< motions
  /// Half-angles and half-lengths that are none, in the unit of the file: rounding of poses that are
  /// thousands of it away from their origin leaves 1e-12, and no sensor is so exact.
  double rounding = 1e-10;
};

/// missing_both; empty where a stream has both parts, or neither. Deterministic; thread-safe.
std::optional<Assumed> missing_in_both(const Motions& motions, const MissingInBothOptions& options = {});

}  // namespace egocal::detail
