// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/missing_in_both.hpp"

#include <algorithm>

#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

std::optional<Assumed> missing_in_both(const Motions& motions, const MissingInBothOptions& options) {
  if (motions.all.size() < options.least) return std::nullopt;
  bool travel = false, turn = false;
  for (const Motion& motion : motions.all)
    for (const DualQuaternion& own : {motion.a, motion.b}) {
      travel = travel || own.dual.norm() > options.rounding;
      turn = turn || own.real.tail<3>().norm() > options.rounding;
    }
  if (travel == turn) return std::nullopt;
  Assumed result;
  // rotations alone show the rotation of the mounting; positions alone show nothing of it, as each is in axes
  // of its own
  result.directions = {true, true, true, travel, travel, travel};
  result.finding.code = "missing_both";
  result.finding.certain = true;
  say(result.finding,
      format("The %s of both streams never change: they are missing, and the motions hold nothing of %s.",
             turn ? "positions" : "rotations", turn ? "the translation" : "the mounting"),
      "Give poses with positions and rotations.");
  return result;
}

}  // namespace egocal::detail
