// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/in_words.hpp"

#include <cstdio>

#include "egocal/microseconds.hpp"

namespace egocal {

std::string counted(std::uint64_t count, std::string_view noun) {
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

std::string span_in_words(std::uint64_t poses, double first, double last) {
  if (poses == 0) return "no poses";
  char text[96];
  if (poses == 1)
    std::snprintf(text, sizeof text, " at %.3f s", first);
  else
    std::snprintf(text, sizeof text, " from %.3f to %.3f s", first, last);
  return counted(poses, "pose") + text;
}

std::string span_in_words(const Trajectory& trajectory) {
  if (trajectory.empty()) return span_in_words(0, 0, 0);
  return span_in_words(trajectory.size(), to_seconds(trajectory.front().time_us),
                       to_seconds(trajectory.back().time_us));
}

std::string rival_offsets_in_words(double period, std::string_view sensor) {
  char every[48];
  std::snprintf(every, sizeof every, "The motion repeats every %.3g s: ", period);
  return every + ("time offsets " + (sensor.empty() ? "" : "of " + std::string(sensor) + " ")) +
         "that differ by that fit as well.";
}

}  // namespace egocal
