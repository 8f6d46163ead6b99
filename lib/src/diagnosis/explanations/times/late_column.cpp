// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/late_column.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/times/moved_answer.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/speeds.hpp"
#include "diagnosis/motions/stillest_point.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Columns: what a second of delay of each coordinate takes off the translation of a motion, in the frame of
/// its begin [m/s].
using OfColumns = std::vector<Matrix3d>;

/// A filter of the first order with time constant c leaves out c times the speed of what it gives.
OfColumns of_columns(const Instants& instants, const Motions& motions, Side side,
                     const LateColumnOptions& late) {
  const std::size_t last = instants.size() - 1;
  const Speeds speeds(instants, late.least_span, late.most_instants);
  OfColumns result;
  for (const std::size_t i : begins_of(instants, motions)) {
    const std::size_t end = std::min(i + static_cast<std::size_t>(motions.stride), last);
    const Vector3d more = speeds.at(end, side) - speeds.at(i, side);
    const PosePair begin = instants.at(i);
    result.emplace_back(rotation_of(side == Side::a ? begin.a : begin.b).transpose() * more.asDiagonal());
  }
  return result;
}

struct LateColumn {
  Side side = Side::b;
  int column = 0;
  double delay = 0, stddev = 0;  ///< [s]
  Explained explained;
  Comparison comparison;  ///< with the motions as they are
};

/// The coordinate whose delay explains most of what is left, if it is a good part of that.
std::optional<int> most_explained(const Explained& given, const OfColumns& added, Side side,
                                  const LateColumnOptions& late) {
  const Vector3d delays = best_numbers<3>(given, added, side);
  const Pose T = to_pose(given.fit.T);
  Vector3d squares = Vector3d::Zero();
  double left = 0;
  for (std::size_t i = 0; i < added.size(); ++i) {
    const double weight = given.fit.weights[i], residual = residual_at(given.motions.all[i], T).translation;
    squares += weight * added[i].colwise().squaredNorm().transpose();
    left += weight * residual * residual;
  }
  const Vector3d explained = squares.cwiseSqrt().cwiseProduct(delays.cwiseAbs());
  Eigen::Index column = 0;
  const double most = explained.maxCoeff(&column);
  if (!(most > late.first_look * std::sqrt(left))) return std::nullopt;
  return static_cast<int>(column);
}

/// Standard deviation of the delay [s], by omitting parts of the drive.
double stddev_of_delay(const Explained& explained, const std::vector<Vector3d>& added, Side side,
                       std::size_t parts) {
  Explained rest = explained;
  std::vector<double> delays;
  const std::size_t n = added.size();
  const auto k = static_cast<double>(parts);
  double mean = 0;
  for (std::size_t part = 0; part < parts; ++part) {
    rest.fit.weights = explained.fit.weights;
    for (std::size_t i = part * n / parts; i < (part + 1) * n / parts; ++i) rest.fit.weights[i] = 0;
    delays.push_back(best_numbers<1>(rest, added, side)[0]);
    mean += delays.back() / k;
  }
  double sum = 0;
  for (const double delay : delays) sum += (delay - mean) * (delay - mean);
  return std::sqrt(sum * (k - 1) / k);
}

std::optional<LateColumn> fitted_column(const Instants& instants, const Explained& given, Side side,
                                        const DiagnosisOptions& options, const LateColumnOptions& late) {
  const OfColumns added = of_columns(instants, given.motions, side, late);
  const std::optional<int> column = most_explained(given, added, side, late);
  if (!column) return std::nullopt;
  std::vector<Vector3d> of_one;
  of_one.reserve(added.size());
  for (const Matrix3d& one : added) of_one.emplace_back(one.col(*column));
  LateColumn found{side, *column, 0, 0, given, {}};
  for (int round = 0; round < options.fit.rounds; ++round) {
    found.delay += best_numbers<1>(found.explained, of_one, side)[0];
    if (!(std::abs(found.delay) <= late.most)) return std::nullopt;
    std::vector<Vector3d> moved = of_one;
    for (Vector3d& one : moved) one *= found.delay;
    found.explained.motions = with_added(given.motions, moved, side);
    found.explained.fit = robust_fit(found.explained.motions, options.fit);
  }
  found.comparison = compare(given, found.explained);
  found.stddev = stddev_of_delay(found.explained, of_one, side, late.parts);
  if (std::abs(found.delay) < late.least || !explains(found.explained, options) ||
      !(number_explains(found.comparison, options) ||
        (found.comparison.gain > late.least_gain && std::abs(found.delay) > late.sigmas * found.stddev)))
    return std::nullopt;
  return found;
}

Finding worded_column(const LateColumn& found, const LateColumn* other) {
  const char which = found.side == Side::a ? 'a' : 'b';
  Finding finding;
  finding.code = std::string("late_positions_") + which;
  finding.improvement = std::exp(found.comparison.gain);
  finding.T_a_b = to_pose(found.explained.fit.T);
  finding.value = found.delay;
  const std::string open =
      other ? format(", or %c of %s is %s by about as much", "xyz"[other->column],
                     mark(other->side == Side::a ? 'a' : 'b'), other -> delay > 0 ? "late" : "early")
            : "";
  say(finding,
      format("One coordinate of the positions of %s, %c, seems to be %s by about %.2g s beside the others",
             mark(which), "xyz"[found.column], found.delay > 0 ? "late" : "early", std::abs(found.delay)),
      format("Give all coordinates of %s of the same times: no filter that delays or smooths one of them, as "
             "that of a height from a barometer.",
             mark(which)),
      open + format(": the squared residuals are %.3g times smaller with all at the same times.",
                    finding.improvement));
  return finding;
}

}  // namespace

std::vector<Finding> late_column(const Instants& instants, const Explained& given,
                                 const DiagnosisOptions& options, const LateColumnOptions& late) {
  if (instants.size() < 3 || given.motions.all.size() < options.motions.least) return {};
  std::optional<LateColumn> best, other;
  for (const Side side : {Side::b, Side::a})
    if (std::optional<LateColumn> here = fitted_column(instants, given, side, options, late))
      (best ? other : best) = std::move(here);
  if (!best) return {};
  if (other && other->comparison.gain > best->comparison.gain) std::swap(best, other);
  if (other && (better(compare(other->explained, best->explained), options.alike, options) ||
                other->comparison.gain < late.as_likely * best->comparison.gain))
    other.reset();
  // filters delay
  if (other && best->delay < 0 && other->delay > 0) std::swap(best, other);
  std::vector<Finding> findings{worded_column(*best, other ? &*other : nullptr)};
  if (other) findings.push_back(worded_column(*other, &*best));
  return findings;
}

void widen_by_late_column(const std::vector<Finding>& late, Answered& answered, Diagnosis& result) {
  if (late.empty() || !late.front().T_a_b) return;
  if (std::none_of(result.findings.begin(), result.findings.end(), [&](const Finding& one) {
        return one.code == late.front().code && one.value == late.front().value;
      }))
    return;
  const Vector6d moved = frame_a_difference(answered.T_a_b, to_dual_quaternion(*late.front().T_a_b));
  widen_by(in_known_directions(moved, answered.observability), answered, result);
}

}  // namespace egocal::detail
