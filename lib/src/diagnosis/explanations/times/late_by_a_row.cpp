// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/late_by_a_row.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/row_changes.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

using Eigen::Vector3d;

/// What the position of a row changes by when it is taken from the row that is `later` rows on.
Vector3d from_another_row(const Trajectory& rows, std::size_t row, int later) {
  const auto last = static_cast<std::ptrdiff_t>(rows.size()) - 1;
  // at the end the step is that of the row before
  const auto from = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(row), later < 0 ? -later : 0,
                                               later > 0 ? last - later : last);
  return position_of(rows[static_cast<std::size_t>(from + later)].pose) -
         position_of(rows[static_cast<std::size_t>(from)].pose);
}

/// Whether the number of rows that suits the motions best is one, and not none.
bool is_one(const Explained& given, const std::vector<Vector3d>& changes, Side side,
            const LateByARowOptions& late) {
  const double number = best_multiple(given, changes, side);
  if (!(std::abs(number - 1) < late.near)) return false;  // the jack-knife takes longer
  const double stddev = jack_knife(given, changes, side, late.blocks, late.fewest);
  return is_expected(number, 1, stddev, late.near, late.sigmas, late.most_sigmas);
}

bool counts(const Evidence& evidence, const LateByARow& found, const DiagnosisOptions& options,
            const LateByARowOptions& late) {
  const Pose given = to_pose(evidence.given.explained.fit.T), here = to_pose(found.explained.fit.T);
  return found.gain > late.least_gain && explains(found.explained, options) &&
         (here.translation - given.translation).norm() >= late.least_change * options.tolerance_translation;
}

/// Usual duration of a row [s].
double seconds_of(const Trajectory& rows) {
  return to_seconds(rows.back().time_us - rows.front().time_us) / static_cast<double>(rows.size() - 1);
}

std::vector<Vector3d> changes_by_a_row(const Evidence& evidence, Side side, int later) {
  const Trajectory& rows = rows_of(evidence, side);
  return changes_of_rows(evidence, side, [&](std::size_t row) { return from_another_row(rows, row, later); });
}

/// The positions of the other stream early where those of this one are late, by what suits them best.
std::optional<LateByARow> by_other_stream(const Evidence& evidence, const LateByARow& found,
                                          const DiagnosisOptions& options, double near) {
  const Explained& given = evidence.given.explained;
  const Side side = found.side == Side::a ? Side::b : Side::a;
  const int later = found.rows > 0 ? -1 : 1;
  std::vector<Vector3d> changes = changes_by_a_row(evidence, side, later);
  double number = best_multiple(given, changes, side);
  if (!(number > 0)) return std::nullopt;
  if (std::abs(number - 1) < near) number = 1;  // in words, the round number would be the likelier one
  for (Vector3d& change : changes) change *= number;
  LateByARow other{side, later * number, seconds_of(rows_of(evidence, side)), 0,
                   with_changes(given, changes, side, options)};
  other.gain = -loss_in_metres(given, other.explained);
  return explains(other.explained, options) ? std::optional(std::move(other)) : std::nullopt;
}

/// Late positions of one stream are those of the other one early, but for what the lever arm turns meanwhile:
/// the best one, and that of the other stream unless it fits clearly worse. Filters delay, so the late one
/// comes first.
std::vector<LateByARow> of_either(std::vector<LateByARow> found, const Evidence& evidence,
                                  const DiagnosisOptions& options, const LateByARowOptions& late) {
  if (found.empty()) return found;
  std::stable_sort(found.begin(), found.end(),
                   [](const LateByARow& x, const LateByARow& y) { return x.gain > y.gain; });
  const auto of_other = std::find_if(found.begin(), found.end(),
                                     [&](const LateByARow& one) { return one.side != found.front().side; });
  std::optional<LateByARow> other = of_other != found.end()
                                        ? std::optional(*of_other)
                                        : by_other_stream(evidence, found.front(), options, late.near);
  std::vector<LateByARow> either{std::move(found.front())};
  if (other && !better(compare(other->explained, either.front().explained), options.alike, options))
    either.insert(other->rows > 0 ? either.begin() : either.end(), *std::move(other));
  return either;
}

}  // namespace

std::vector<LateByARow> late_by_a_row(const Evidence& evidence, const DiagnosisOptions& options,
                                      const LateByARowOptions& late) {
  const Explained& given = evidence.given.explained;
  std::vector<LateByARow> found;
  for (const Side side : {Side::b, Side::a}) {
    const Trajectory& rows = rows_of(evidence, side);
    constexpr std::size_t least_rows = 3;  // one that has a row on either side
    if (rows.size() < least_rows ||
        way_in_a_row(evidence, side) < late.least_change * options.tolerance_translation)
      continue;
    for (const int later : {1, -1}) {
      const std::vector<Vector3d> changes = changes_by_a_row(evidence, side, later);
      if (!is_one(given, changes, side, late)) continue;
      LateByARow here{side, static_cast<double>(later), seconds_of(rows), 0,
                      with_changes(given, changes, side, options)};
      here.gain = -loss_in_metres(given, here.explained);
      if (counts(evidence, here, options, late)) found.push_back(std::move(here));
    }
  }
  return of_either(std::move(found), evidence, options, late);
}

std::vector<Finding> worded_rows(const std::vector<LateByARow>& found, const Evidence& evidence) {
  std::vector<Finding> findings;
  for (const LateByARow& one : found) {
    const char which = one.side == Side::a ? 'a' : 'b', rest = which == 'a' ? 'b' : 'a';
    Finding finding;
    finding.code = std::string("late_positions_") + which;
    finding.certain = found.size() == 1;
    finding.improvement = std::exp(std::max(0.0, compare(evidence.given.explained, one.explained).gain));
    finding.T_a_b = to_pose(one.explained.fit.T);
    finding.value = one.rows * one.seconds;
    const std::string by = std::abs(one.rows) == 1 ? format("one row (%.3g s)", one.seconds)
                                                   : format("%.3g s", std::abs(*finding.value));
    const std::string open = finding.certain ? ""
                                             : format(", or those of %s are %s by as much", mark(rest),
                                                      one.rows > 0 ? "earlier" : "later");
    say(finding,
        format("The positions of %s are %s %s than its rotations", mark(which), by.c_str(),
               one.rows > 0 ? "later" : "earlier"),
        format("Write position and rotation of the same time into each row of %s.", mark(which)),
        open + format(": the squared residuals of the translations are %.3g times smaller without that.",
                      std::exp(one.gain)));
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace egocal::detail
