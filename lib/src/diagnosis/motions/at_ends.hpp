// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace egocal::detail {

/// What each motion has at its begin and at its end, taken from a pass over all instants of a drive: of a
/// long drive the few thousand motions are held, never the poses.
template <typename Value>
class AtEnds {
 public:
  /// motions: their begins [instants], in order; must stay. span: each one's length [instants].
  AtEnds(const std::vector<std::size_t>& motions, std::size_t span) : motions_(motions), span_(span) {
    begins.reserve(motions.size());
    ends.reserve(motions.size());
  }
  /// The value at an instant. To be called in order, for all instants.
  void pass(std::size_t instant, const Value& value) {
    while (begins.size() < motions_.size() && motions_[begins.size()] == instant) begins.push_back(value);
    while (ends.size() < motions_.size() && motions_[ends.size()] + span_ == instant) ends.push_back(value);
  }

  std::vector<Value> begins, ends;

 private:
  const std::vector<std::size_t>& motions_;
  std::size_t span_;
};

}  // namespace egocal::detail
