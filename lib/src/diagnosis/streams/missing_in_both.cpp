// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/missing_in_both.hpp"

#include <algorithm>

#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

std::optional<Assumed> missing_in_both(const Instants& instants, const Motions& motions,
                                       const MissingInBothOptions& options) {
  if (motions.all.size() < options.least || instants.empty()) return std::nullopt;
  // where positions never change one tells how far away they are
  const PosePair any = instants.at(0);
  const double rounding =
      std::max(options.rounding, options.digits * std::max(any.a.dual.norm(), any.b.dual.norm()));
  bool travel = false, turn = false;
  for (const Motion& motion : motions.all)
    for (const DualQuaternion& own : {motion.a, motion.b}) {
      travel = travel || own.dual.norm() > rounding;
      turn = turn || own.real.tail<3>().norm() > options.rounding;
    }
  if (travel == turn) return std::nullopt;
  Assumed result;
  result.finding.code = "missing_both";
  if (turn) {
    // rotations alone show that of the mounting
    result.directions = {true, true, true, false, false, false};
    result.finding.certain = true;
    say(result.finding,
        "The positions of both streams never change: they are missing, and the motions hold nothing of the "
        "translation.",
        "Give poses with positions and rotations.");
  } else {
    say(result.finding,
        "The rotations of both streams never change: if they are missing, the rotation of the answer is that "
        "between the axes of both files, and none of the sensors'.",
        "Give poses with positions and rotations; ignore this where the sensors move along rails.");
  }
  return result;
}

}  // namespace egocal::detail
