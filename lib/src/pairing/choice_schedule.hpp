// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// When the pairs of one rig choose their weights.
#pragma once

#include <algorithm>
#include <cstdint>

#include "egocal/pairing/stride_sums.hpp"

namespace egocal::detail {

/// By how many instants a choice due at `next` is delayed, if the following one comes after next / part more.
/// phase: AccumulatorOptions::choice_phase.
inline std::uint64_t choice_delay(std::uint64_t next, std::uint64_t part, double phase) {
  const std::uint64_t between = next / part;
  return static_cast<std::uint64_t>(phase * static_cast<double>(between));
}

/// When the sums over strides choose again. It depends on the number of instants alone, so it is known before
/// the sums are.
class SumsSchedule {
 public:
  SumsSchedule(const StrideSumsOptions& tuning, const AccumulatorOptions& options)
      : short_drive_(tuning.short_drive),
        short_part_(tuning.short_choice_part),
        long_part_(tuning.choice_part),
        phase_(options.choice_phase) {}

  /// next: StrideSumsState::next_choice.
  bool is_due(std::uint64_t instants, std::uint64_t next) const { return instants >= next + delay(next); }
  /// The next one after a choice that is made now. One before it was due: from then on.
  std::uint64_t after_choice(std::uint64_t instants, std::uint64_t next) const {
    const std::uint64_t without_delay = instants - std::min(instants, delay(next));
    const std::uint64_t due = std::min(without_delay, next);
    return due + std::max<std::uint64_t>(1, due / part(due));
  }

 private:
  /// The divisor n by which the next choice follows after 1 / n of this number of instants more.
  std::uint64_t part(std::uint64_t instants) const {
    return instants < short_drive_ ? short_part_ : long_part_;
  }
  std::uint64_t delay(std::uint64_t next) const { return choice_delay(next, part(next), phase_); }

  std::uint64_t short_drive_, short_part_, long_part_;
  double phase_;
};

}  // namespace egocal::detail
