// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/frame_counts.hpp"

#include "egocal/printable.hpp"

namespace egocal::detail {

void FrameCounts::add(std::string_view parent, std::string_view child) {
  constexpr std::size_t most = 8;  // a limit: as many as a line of text can name
  if (parent.empty() && child.empty()) return;
  for (Frames& frames : frames_)
    if (frames.parent == parent && frames.child == child) {
      ++frames.messages;
      return;
    }
  if (frames_.size() < most)
    frames_.push_back({std::string(parent), std::string(child), 1});
  else
    ++others_;
}

std::string FrameCounts::mixed() const {
  if (frames_.size() < 2) return {};
  std::string text = "poses of several frames are mixed: ";
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Frames& frames = frames_[i];
    const std::string parent = printable(frames.parent.empty() ? "(no name)" : frames.parent, 60);
    text += (i > 0 ? ", " : "") + parent +
            (frames.child.empty() ? "" : " to " + printable(frames.child, 60)) + " (" +
            std::to_string(frames.messages) + ")";
  }
  if (others_ > 0) text += ", others (" + std::to_string(others_) + ")";
  return text + "; record each on a topic of its own";
}

}  // namespace egocal::detail
