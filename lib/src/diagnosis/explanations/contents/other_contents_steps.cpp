// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/contents/other_contents_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/row_changes.hpp"
#include "diagnosis/explanations/times/late_positions.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

using Eigen::Vector3d;
using Changes = std::vector<Vector3d>;

/// Parts of a row by which steps are turned on where the attitude at its end is taken for that at its begin
/// (steps between poses), or either for that in its middle (a speed times the duration of a row).
constexpr std::array<double, 3> parts_of_mistakes{1, 0.5, -0.5};

/// What the motions change by where each step is turned back by a part of the turn of its row.
Changes changes_of(const Evidence& evidence, Side side, double part) {
  const Trajectory& rows = rows_of(evidence, side);
  Vector3d sum = Vector3d::Zero();
  Pose before = to_pose(rows.front().pose);
  return changes_of_rows(evidence, side, [&](std::size_t row) {
    const Pose here = to_pose(rows[row].pose);
    const Vector3d step = here.translation - before.translation;
    const Vector3d turn = rotation_log(here.rotation * before.rotation.conjugate());
    if (row > 0) sum += rotation_exp(-part * turn) * step - step;
    before = here;
    return sum;
  });
}

bool fits_late_positions_better(const Evidence& evidence, const Explained& steps,
                                const DiagnosisOptions& options) {
  const std::optional<LateOfEither> late =
      best_late_positions(evidence.instants, evidence.given.explained, options);
  return late && (loss_in_metres(late->best.explained, steps) > 0 ||
                  (late->other && loss_in_metres(late->other->explained, steps) > 0));
}

/// Sets which part suits the motions best; whether that is what the mistake makes.
bool is_that_part(const Explained& given, const Changes& changes, const TurnedStepsOptions& turned,
                  TurnedSteps& steps) {
  steps.fitted = steps.part * best_multiple(given, changes, steps.side);
  if (!(std::abs(steps.fitted - steps.part) < turned.near)) return false;
  steps.stddev = std::abs(steps.part) * jack_knife(given, changes, steps.side, turned.blocks, turned.fewest);
  return is_expected(steps.fitted, steps.part, steps.stddev, turned.near, turned.sigmas, turned.most_sigmas);
}

/// Whether the streams agree better by what matters, and no delay does it.
bool counts(const Evidence& evidence, const TurnedSteps& steps, const DiagnosisOptions& options,
            const TurnedStepsOptions& turned) {
  const Pose given = to_pose(evidence.given.explained.fit.T), here = to_pose(steps.explained.fit.T);
  return steps.gain > turned.least_gain &&
         (here.translation - given.translation).norm() >=
             turned.least_change * options.tolerance_translation &&
         explains(steps.explained, options) &&
         !fits_late_positions_better(evidence, steps.explained, options);
}

}  // namespace

std::vector<TurnedSteps> turned_steps(const Evidence& evidence, const DiagnosisOptions& options,
                                      const TurnedStepsOptions& turned) {
  const Explained& given = evidence.given.explained;
  std::vector<TurnedSteps> found;
  for (const Side side : {Side::b, Side::a}) {
    if (rows_of(evidence, side).size() < 2 ||
        way_in_a_row(evidence, side) < turned.least_change * options.tolerance_translation)
      continue;
    const double about = best_multiple(given, changes_of(evidence, side, 1), side);
    for (const double part : parts_of_mistakes) {
      // turns of some tenths of a radian in a row are not quite proportional to the part
      if (!(std::abs(about - part) < 2 * turned.near)) continue;
      TurnedSteps here{side, part, 0, 0, 0, {}};
      const Changes changes = changes_of(evidence, side, part);
      if (!is_that_part(given, changes, turned, here)) continue;
      here.explained = with_changes(given, changes, side, options);
      here.gain = -loss_in_metres(given, here.explained);
      if (counts(evidence, here, options, turned)) found.push_back(std::move(here));
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const TurnedSteps& x, const TurnedSteps& y) { return x.gain > y.gain; });
  return found;
}

std::vector<Finding> worded_steps(const std::vector<TurnedSteps>& found, const Evidence& evidence,
                                  const DiagnosisOptions& options, const TurnedStepsOptions& turned) {
  std::vector<Finding> findings;
  for (const TurnedSteps& one : found) {
    if (one.gain < found.front().gain - options.alike) break;
    const char which = one.side == Side::a ? 'a' : 'b';
    Finding finding;
    finding.code = std::string("axes_") + which;
    finding.certain = std::abs(one.fitted) >= turned.certain * one.stddev;
    finding.improvement = std::exp(std::max(0.0, compare(evidence.given.explained, one.explained).gain));
    finding.T_a_b = to_pose(one.explained.fit.T);
    say(finding,
        format("The positions of %s are summed up from steps that are turned by attitudes %s row too %s",
               mark(which), one.part == 1 ? "a" : "half a", one.part > 0 ? "late" : "early"),
        format(
            "Turn each step of %s by the attitude that it was measured in: at the begin of the row for steps "
            "from pose to pose, in its middle for a speed times a duration.",
            mark(which)),
        format(": the squared residuals of the translations are %.3g times smaller "
               "without that.",
               std::exp(one.gain)));
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace egocal::detail
