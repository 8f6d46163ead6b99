// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Positions, or rotations, that never change in either stream, as of two attitude sensors whose poses were
// filled up with zeros. The motions then agree about the translation without an error, and hold nothing of
// it.
#pragma once

#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "diagnosis/streams/assumed.hpp"

namespace egocal::detail {

struct MissingInBothOptions {
  std::size_t least = 20;  ///< motions
  /// Half-angles and half-lengths that are none [rad, and in the unit of the file]: no sensor is so exact.
  double rounding = 1e-10;
  double digits =
      1e-14;  ///< the same of the distance from the origin: what computing with such a pose leaves
};

/// missing_both: certain without positions, uncertain without rotations, as machines on rails have none;
/// empty where a stream has both parts, or neither. Deterministic; thread-safe. instants: of the motions.
std::optional<Assumed> missing_in_both(const Instants& instants, const Motions& motions,
                                       const MissingInBothOptions& options = {});

}  // namespace egocal::detail
