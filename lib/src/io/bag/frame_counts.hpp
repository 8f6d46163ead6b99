// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace egocal::detail {

/// The frames that the messages of one topic name. Poses of several frames are no trajectory of one sensor.
class FrameCounts {
 public:
  /// Empty names do not count as another frame, as many senders omit them.
  void add(std::string_view parent, std::string_view child);
  /// "poses of several frames are mixed: map (600), odom (600)"; empty: all are of one frame.
  std::string mixed() const;

 private:
  struct Frames {
    std::string parent, child;
    std::uint64_t messages = 0;
  };
  std::vector<Frames> frames_;
  std::uint64_t others_ = 0;  ///< messages of more frames than are kept
};

}  // namespace egocal::detail
