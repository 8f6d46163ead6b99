// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "egocal/moves/find_moves.hpp"
#include "moves/change_test.hpp"
#include "moves/linear_blocks.hpp"

namespace egocal::detail {

/// The motions that changes are looked for in.
struct TestedDrive {
  std::span<const MotionPair> pairs;  ///< only those in which the vehicle moves
  std::int64_t origin_us = 0;         ///< times of moves are counted from here
  Problem problem;                    ///< weighted_by_noise()
  const MovesOptions& options;
  std::size_t overlap = 0;  ///< motions that share a pose
};

/// A change within a stretch of them.
struct FoundChange {
  std::size_t from = 0, to = 0;  ///< the stretch that was tested, pairs
  std::size_t at = 0;            ///< first pair after
  ChangeTest test;
  Linearised stretch;
  bool creep = false;
  bool of_two = false;  ///< found with another one: not tested by itself yet
  bool certain = true;
};

}  // namespace egocal::detail
