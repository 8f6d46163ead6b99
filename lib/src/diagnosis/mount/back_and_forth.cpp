// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/back_and_forth.hpp"

#include <utility>
#include <vector>

#include "diagnosis/mount/mount_pairs.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/microseconds.hpp"
#include "moves/switching.hpp"

namespace egocal::detail {

std::optional<Finding> back_and_forth(const Instants& instants, const Answered& answered,
                                      const DiagnosisOptions& options) {
  std::optional<Switching> found;
  double begin = 0;
  for (const std::vector<MotionPair>& pairs : strides_of(instants, answered, options, {})) {
    std::optional<Switching> here = find_switching(pairs, answered.problem);
    if (!here || (found && found->left <= here->left)) continue;
    found = std::move(here);
    begin = to_seconds(pairs.front().begin_us);
  }
  if (!found) return std::nullopt;
  const ExtrinsicError apart = extrinsic_error(found->first, found->second);
  const MovesOptions least;  // as large as odometry errs
  if (apart.rotation < least.least_rotation && apart.translation < least.least_translation)
    return std::nullopt;
  Finding finding;
  finding.code = "mount_moved";
  finding.certain = true;
  finding.improvement = 1 / found->left;
  finding.time = begin + found->time;
  finding.T_a_b = to_pose(found->first);
  finding.message = format(
      "The mounting goes back and forth between two places, %zu times, first about %.0f s after the start. "
      "They are %.2g deg and %s apart.",
      found->switches, *finding.time, apart.rotation * degrees_per_radian,
      length_in_words(apart.translation, options.unit == LengthUnit::metres).c_str());
  finding.remedy = "Fasten the mounting, and record again.";
  return finding;
}

}  // namespace egocal::detail
