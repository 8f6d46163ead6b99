// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/pairing/match_samples.hpp"
#include "egocal/pairing/poses_of_file.hpp"

namespace egocal {

/// Samples by the rows of their files.
struct MatchedRows {
  MatchedSamples matched;  ///< its rows are those of the files, from 0
  /// Factor of the times of b after which they are those of a: a power of 1000 where one list was read in
  /// another unit.
  double times_of_b = 1;
  /// Matched by row, and stamps of a list are equal, so that they do not tell its rows apart.
  bool stamps_repeat = false;
};

/// match_samples() of files: row by row means that they have the same place in their files, and rows without
/// a pose keep theirs. Stamps may repeat and step back; of equal ones the first counts, unless rows and
/// stamps agree. Throws Error as match_samples() does. Thread-safe.
MatchedRows match_rows(const PosesOfFile& a, const PosesOfFile& b, const MatchingOptions& options = {});

}  // namespace egocal
