// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Interpolated poses that are asked for again and again.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal::detail {

/// What was interpolated at each instant, or that nothing could be. The diagnosis looks at each instant
/// hundreds of times, and an interpolation takes as long as all else that is done with its pose. Threads may
/// ask at the same time: each gets what it would have worked out itself.
class RememberedPoses {
 public:
  explicit RememberedPoses(std::size_t instants) : states_(instants), poses_(instants) {}

  /// work_out() is called where the instant is not known yet, and gives the same each time.
  template <typename WorkOut>
  std::optional<DualQuaternion> at(std::size_t instant, const WorkOut& work_out) {
    std::atomic<State>& state = states_[instant];
    const State now = state.load(std::memory_order_acquire);
    if (now == State::pose) return poses_[instant];
    if (now == State::no_pose) return std::nullopt;
    const std::optional<DualQuaternion> result = work_out();
    State expected = State::unknown;
    if (state.compare_exchange_strong(expected, State::being_written, std::memory_order_acquire)) {
      if (result) poses_[instant] = *result;
      state.store(result ? State::pose : State::no_pose, std::memory_order_release);
    }
    return result;
  }

 private:
  enum class State : std::uint8_t { unknown, being_written, pose, no_pose };
  std::vector<std::atomic<State>> states_;
  std::vector<DualQuaternion> poses_;
};

}  // namespace egocal::detail
