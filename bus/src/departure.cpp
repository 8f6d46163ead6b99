// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/departure.hpp"

#include <cstdio>
#include <numbers>

namespace egocal::bus {

std::optional<Departure> departure(Verdict verdict, const Judged& judged, const Pose& T_a_b,
                                   const DepartureOptions& options) {
  if (verdict != Verdict::good) return std::nullopt;
  const Pose before = to_pose(judged.T_a_b);
  const Departure moved{rotation_log(before.rotation.conjugate() * T_a_b.rotation).norm(),
                        (T_a_b.translation - before.translation).norm()};
  // lengths on the bus are metres: of each pair a sensor measures them (docs/rig.md, `scale`), and the
  // diagnosis judged by them. Written so that what is not finite has moved
  const bool holds = moved.rotation <= options.rotation && moved.translation <= options.translation;
  return holds ? std::nullopt : std::optional(moved);
}

std::string in_words(const Departure& departure) {
  char text[160];
  std::snprintf(text, sizeof text, "the answer has moved by %.2f deg and %.0f cm since it was judged",
                departure.rotation * 180 / std::numbers::pi, departure.translation * 100);
  return text;
}

}  // namespace egocal::bus
