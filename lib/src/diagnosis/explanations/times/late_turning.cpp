// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/late_turning.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnosis/explanations/times/early_rotations.hpp"
#include "diagnosis/explanations/times/moved_answer.hpp"
#include "diagnosis/motions/mount_fit.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Columns: the axes of the turning of b over many motions, in its frame.
Matrix3d axes_of_turning(const Instants& instants, int stride, const LateTurningOptions& late) {
  const auto step = static_cast<std::size_t>(std::max(1, stride));
  Matrix3d turns = Matrix3d::Zero();
  const std::size_t motions = (instants.size() - 1) / step, in_a_row = std::min(motions, late.in_a_row);
  const std::size_t begins = motions - in_a_row + 1, places = std::min(begins, late.places);
  for (std::size_t place = 0; place < places; ++place) {
    const std::size_t begin = place * begins / places;
    Vector3d turn = Vector3d::Zero();
    Rotation from = to_pose(instants.at(begin * step).b).rotation;
    for (std::size_t k = begin + 1; k <= begin + in_a_row; ++k) {
      const Rotation to = to_pose(instants.at(k * step).b).rotation;
      turn += rotation_log(from.conjugate() * to);
      from = to;
    }
    turns += turn * turn.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(turns).eigenvectors();
}

std::optional<LateTurning> about(const Vector3d& axis, const Instants& instants, const Explained& given,
                                 const LateTurningOptions& late) {
  const StreamOfTwoTimes of_b(instants, given, Side::b, late.times, axis);
  const std::vector<LinearMotion> rotations = of_b.rotations(given, late.times.fit.most);
  if (rotations.size() < late.least) return std::nullopt;
  const MountFit turning(rotations, late.times.fit);
  const MountNumbers x = turning.best(FreeNumbers::two), here = MountNumbers::Unit(time_about_axis),
                     others = MountNumbers::Unit(time_about_others);
  LateTurning found;
  // the rotations of b are those of earlier times where it is late
  const double sign = here.dot(x) < 0 ? -1 : 1;
  found.side = sign < 0 ? Side::b : Side::a;
  found.seconds = sign * here.dot(x);
  found.others = sign * others.dot(x);
  found.stddev = turning.stddev(here);
  found.apart_stddev = turning.stddev(here - others);
  found.gain = turning.gain(turning.best(FreeNumbers::none), turning.best(FreeNumbers::first));
  const Vector3d in_late = found.side == Side::b ? axis : to_pose(given.fit.T).rotation * axis;
  const StreamOfTwoTimes stream(instants, given, found.side, late.times, in_late);
  const std::vector<LinearMotion> motions = stream.motions(given, late.times.fit.most);
  const MountFit fit(motions, late.times.fit);
  found.T_a_b = stream.T_a_b(fit.best(FreeNumbers::first));
  found.T_a_b_as_given = stream.T_a_b(fit.best(FreeNumbers::none));
  return found;
}

bool is_late(const LateTurning& found, const LateTurningOptions& late) {
  return found.sigmas() > late.sigmas &&
         found.seconds - found.others > late.sigmas_apart * found.apart_stddev &&
         std::abs(found.others) < late.most_of_others * found.seconds && found.gain > late.least_gain;
}

Finding worded_late_turning(const LateTurning& found, const Vector6d& moved, const Answered& answered) {
  const char which = found.side == Side::a ? 'a' : 'b', rest = which == 'a' ? 'b' : 'a';
  Finding finding;
  finding.code = "mount_moved";
  finding.improvement = std::exp(std::max(0.0, found.gain));
  finding.T_a_b = to_pose(frame_a_moved(answered.T_a_b, moved));
  say(finding,
      format("%s may be on a part that is towed, or %s on one that is steered: about one axis %s turns about "
             "%.2g s later, about the others it does not",
             mark(which), mark(rest), mark(which), found.seconds),
      "Fasten both sensors to one rigid part, and record again.",
      format(", which the turns show by %.0f standard deviations. A filter that delays one angle of %s looks "
             "like that, too. The answer is another one then.",
             found.sigmas(), mark(which)));
  return finding;
}

}  // namespace

double LateTurning::sigmas() const {
  return stddev > 0 ? seconds / stddev : 0;
}

std::optional<LateTurning> late_turning(const Instants& instants, const Explained& given,
                                        const LateTurningOptions& late) {
  if (instants.size() < 2 || given.motions.all.size() < late.least) return std::nullopt;
  const Matrix3d axes = axes_of_turning(instants, given.motions.stride, late);
  std::optional<LateTurning> best;
  for (int i = 2; i >= 0; --i) {
    const std::optional<LateTurning> here = about(axes.col(i), instants, given, late);
    if (here && is_late(*here, late) && (!best || here->sigmas() > best->sigmas())) best = here;
  }
  return best;
}

void name_late_turning(const Evidence& evidence, const DiagnosisOptions& options, Answered& answered,
                       Diagnosis& result, const LateTurningOptions& late) {
  if (std::any_of(result.findings.begin(), result.findings.end(),
                  [&](const Finding& one) { return explains_early(one, options); }))
    return;
  const std::optional<LateTurning> found = late_turning(evidence.instants, evidence.given.explained, late);
  if (!found) return;
  const Vector6d moved =
      in_known_directions(frame_a_difference(found->T_a_b_as_given, found->T_a_b), answered.observability);
  if (!matters(moved, answered, options, late.least_move, late.matters)) return;
  // a clock between the times about several axes
  std::erase_if(result.findings, [](const Finding& one) { return one.code == "clock_offset"; });
  result.findings.insert(result.findings.begin(), worded_late_turning(*found, moved, answered));
  widen_by(moved, answered, result);
}

}  // namespace egocal::detail
