// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/contradicting_runs.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Whether each motion contradicts the answer. Motions at rest contradict nothing.
std::vector<bool> contradicting(const Motions& motions, const Pose& T_a_b,
                                const ContradictingRunsOptions& options) {
  const std::vector<bool> rest = at_rest(motions, T_a_b), one_rests = one_at_rest(motions);
  std::vector<Residual> residuals;
  std::vector<double> rotations, translations;
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    residuals.push_back(residual_at(motions.all[i], T_a_b));
    if (rest[i] || one_rests[i]) continue;
    rotations.push_back(residuals.back().rotation);
    translations.push_back(residuals.back().translation);
  }
  const double rotation = options.times * median(std::move(rotations)),
               translation = options.times * median(std::move(translations));
  std::vector<bool> result(motions.all.size(), false);
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    if (rest[i] || one_rests[i]) continue;
    const Motion& motion = motions.all[i];
    const Residual& left = residuals[i];
    const bool turns =
        left.rotation > std::max({rotation, options.least_rotation,
                                  options.of_motion * std::max(motion.angle_a, motion.angle_b)});
    const bool travels =
        left.translation >
        std::max(translation, options.of_motion * std::max(motion.t_a.norm(), motion.t_b.norm()));
    result[i] = turns || travels;
  }
  return result;
}

}  // namespace

ContradictingRuns contradicting_runs(const Motions& motions, double period, const Pose& T_a_b,
                                     const ContradictingRunsOptions& options) {
  ContradictingRuns found;
  if (motions.all.size() < 2) return found;
  const std::vector<bool> contradicts = contradicting(motions, T_a_b, options);
  const double least = (motions.stride + options.least_instants) * period;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= contradicts.size(); ++i) {
    if (i < contradicts.size() && contradicts[i]) continue;
    if (i > begin) {
      const double lasts = motions.all[i - 1].time - motions.all[begin].time;
      if (lasts > least) {
        ++found.runs;
        found.seconds += lasts;
      }
    }
    begin = i + 1;
  }
  found.part = found.seconds / (motions.all.back().time - motions.all.front().time);
  return found;
}

void name_contradicting_runs(const Instants& instants, const Motions& motions, const Pose& T_a_b,
                             const MotionSampleOptions& sample, std::vector<Finding>& findings,
                             const ContradictingRunsOptions& options) {
  if (std::any_of(findings.begin(), findings.end(), [](const Finding& one) {
        return certain_of_either(one) || one.code == "mount_moved" || one.code == "too_little_motion";
      }))
    return;
  const Motions shorter =
      motions_of(instants, {}, {}, std::max(1, motions.stride / options.shorter), sample.most, sample);
  ContradictingRuns found;
  for (const Motions* looked_at : {&motions, &shorter}) {
    const ContradictingRuns here = contradicting_runs(*looked_at, instants.period, T_a_b, options);
    if (here.runs >= options.least_runs && here.part > found.part) found = here;
  }
  if (!(found.part >= options.least_part)) return;
  Finding finding;
  finding.code = "mount_moved";
  finding.message = format(
      "These motions contradict each other: in %zu parts of the drive, together %.3g s or %.0f %% of it, the "
      "answer of the others explains no motion. A sensor is on a part that is towed, steered or sprung, or "
      "its odometry is lost again and again.",
      found.runs, found.seconds, 100 * found.part);
  finding.remedy = "Fasten both sensors to one rigid part, and record again.";
  findings.insert(findings.begin(), std::move(finding));
}

}  // namespace egocal::detail
