// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A verdict arrives seconds after the answer that it judges. Programs that show it beside a newer answer
// check here whether it still holds.
#pragma once

#include <optional>
#include <string>

#include "egocal/bus/verdict.hpp"
#include "egocal/diagnosis/options.hpp"
#include "egocal/geometry/pose.hpp"

namespace egocal::bus {

/// Further than this from the judged one an answer is another one [rad, m]: a good answer is known to that,
/// so one of the two is wrong. Within it they differ by no more than a good answer may be off. Study:
/// docs/trust_measured.md, "Live".
struct DepartureOptions {
  double rotation = DiagnosisOptions{}.tolerance_rotation;
  double translation = DiagnosisOptions{}.tolerance_translation;
};

/// How far an answer has moved since it was judged [rad, m].
struct Departure {
  double rotation = 0, translation = 0;
};

/// Empty: the verdict holds for this answer. Only good ones are lost by moving: an incomplete one does not
/// say where the answer is, and the others remain true of the motions.
std::optional<Departure> departure(Verdict verdict, const Judged& judged, const Pose& T_a_b,
                                   const DepartureOptions& options = {});

/// "the answer has moved by 1.67 deg and 2 cm since it was judged".
std::string in_words(const Departure& departure);

}  // namespace egocal::bus
