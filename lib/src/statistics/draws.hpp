// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace egocal::detail {

/// Subsets of searches are drawn with Knuth's linear congruential generator from one state: a search tries
/// the same ones every time.
class Draws {
 public:
  /// A number from 0 to count - 1; count: from 1 to 2^31.
  std::size_t below(std::size_t count) {
    drawn_ = 6364136223846793005u * drawn_ + 1442695040888963407u;
    return static_cast<std::size_t>((drawn_ >> 33) % count);
  }

 private:
  std::uint64_t drawn_ = 1;
};

}  // namespace egocal::detail
