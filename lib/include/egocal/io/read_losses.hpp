// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace egocal {

/// What a recording has lost: nothing is dropped without being counted here.
struct ReadLosses {
  std::uint64_t regions = 0;  ///< damaged places that were skipped
  std::uint64_t bytes = 0;    ///< in them, as far as they could be counted
  bool truncated = false;     ///< the file ends in the middle of a record: a recorder that was killed
  bool checksum = false;      ///< the checksum of the whole data differs, and nothing shows where
  std::uint64_t refused = 0;  ///< messages or rows that could be read but hold no pose: NaN, zero quaternion
  std::string first_refused;  ///< why the first of them was refused, and where

  bool any() const { return regions > 0 || truncated || checksum || refused > 0; }
};

/// "2 damaged regions (381 bytes) skipped, the end is cut off"; empty where nothing was lost.
std::string losses_in_words(const ReadLosses& losses);

}  // namespace egocal
