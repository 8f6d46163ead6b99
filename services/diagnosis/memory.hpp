// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/drive_sample.hpp"
#include "diagnosis/followed_clock.hpp"
#include "egocal/pairing/stream.hpp"

namespace egocal::services {

/// What a diagnosis knows of the session of one pair, except the problem, which pairing sends again.
struct PairMemory {
  DriveSampleState sample;
  std::int64_t session = -1;            ///< of the newest problem; -1: none was received
  std::int64_t matched = 0;             ///< motions in it
  std::int64_t matched_before = 0;      ///< motions of the session before the sample begins
  std::int64_t matched_between = 0;     ///< motions while no diagnosis ran
  std::int64_t missed_us = 0;           ///< their time
  std::int64_t restarted_session = -1;  ///< for which a reset was sent
  std::vector<OffsetSince> offsets;     ///< of the clock of b, see FollowedClock
};

/// What the next diagnosis process continues from.
struct Memory {
  std::vector<StreamState> streams;  ///< as the rig's sensors
  std::vector<PairMemory> pairs;     ///< as the rig's pairs
};

}  // namespace egocal::services
