// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/contents/reversed_steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/row_changes.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

/// The part of each step that is the wrong way round.
enum class Reversed { step, rotation };

Pose right_step(const Pose& step, Reversed reversed) {
  return reversed == Reversed::step ? inverse(step) : Pose{step.rotation.conjugate(), step.translation};
}

/// The right motion, nearly, where the steps of the motion are short.
Pose right_motion(const Pose& motion, Reversed reversed) {
  const Pose other_way = inverse(motion);
  return reversed == Reversed::step ? other_way : Pose{other_way.rotation, -other_way.translation};
}

struct Moment {
  double time = 0;        ///< as Instants::time() [s]
  std::size_t place = 0;  ///< of its pose in the result
};

Pose between(const Pose& from, const Pose& to, double part) {
  const Pose step = inverse(from) * to;
  return {(from.rotation * rotation_exp(part * rotation_log(step.rotation))).normalized(),
          from.translation + part * (to.translation - from.translation)};
}

/// The poses that the rows make with their steps put right, at each of these moments (in ascending order):
/// the rows of a long drive are gone over once and not held.
std::vector<Pose> summed_up(const Evidence& evidence, Side side, Reversed reversed,
                            const std::vector<Moment>& moments) {
  const Trajectory& rows = rows_of(evidence, side);
  const Times times(rows, evidence.streams.a.front().time_us,
                    side == Side::a ? ClockModel{} : evidence.clock);
  std::vector<Pose> result(moments.size());
  Pose before = to_pose(rows.front().pose), here;
  std::size_t next = 0;
  for (std::size_t row = 0; row + 1 < rows.size() && next < moments.size(); ++row) {
    const Pose after = to_pose(rows[row + 1].pose);
    Pose there = here * right_step(inverse(before) * after, reversed);
    there.rotation.normalize();
    const double from = times[row], to = times[row + 1];
    const bool last = row + 2 == rows.size();
    for (; next < moments.size() && (last || moments[next].time < to); ++next) {
      const double part = to > from ? std::clamp((moments[next].time - from) / (to - from), 0.0, 1.0) : 0;
      result[moments[next].place] = between(here, there, part);
    }
    before = after;
    here = there;
  }
  return result;
}

/// The motions that are compared, with the steps of one stream put right.
Explained with_right_steps(const Evidence& evidence, Side side, Reversed reversed,
                           const DiagnosisOptions& options) {
  Explained result{evidence.given.explained.motions, {}};
  const auto span = static_cast<std::size_t>(result.motions.stride);
  const std::vector<std::size_t> begins = begins_of(evidence.instants, result.motions);
  std::vector<Moment> moments;
  moments.reserve(2 * begins.size());
  for (std::size_t i = 0; i < begins.size(); ++i) {
    moments.push_back({evidence.instants.time(begins[i]), 2 * i});
    moments.push_back({evidence.instants.time(begins[i] + span), 2 * i + 1});
  }
  std::sort(moments.begin(), moments.end(), [](const Moment& x, const Moment& y) { return x.time < y.time; });
  const std::vector<Pose> poses = summed_up(evidence, side, reversed, moments);
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const Pose motion = inverse(poses[2 * i]) * poses[2 * i + 1];
    set_turned_motion(result.motions.all[i], side, motion.rotation, motion.translation);
  }
  measure_sizes(result.motions);
  result.fit = robust_fit(result.motions, options.fit);
  return result;
}

bool is_promising(const Motions& motions, Side side, Reversed reversed, const DiagnosisOptions& options,
                  const ReversedStepsOptions& search) {
  if (motions.all.size() < options.motions.least) return false;
  Motions other = motions;
  for (Motion& motion : other.all) {
    const Pose right = right_motion(to_pose(side == Side::a ? motion.a : motion.b), reversed);
    set_turned_motion(motion, side, right.rotation, right.translation);
  }
  measure_sizes(other);
  return quick_fit(other, options.fit).typical < search.promising * quick_fit(motions, options.fit).typical;
}

/// Whether b is mounted back to front and upside down, nearly (ReversedStepsOptions::like_mounting).
bool like_mounting(const DualQuaternion& T, const ReversedStepsOptions& search) {
  const Rotation flipped(0, 0, 1, 0);  // half a turn about y
  return rotation_log(to_pose(T).rotation * flipped.conjugate()).norm() < search.like_mounting;
}

Finding worded_whole(const Explained& right, const Comparison& comparison, bool certain) {
  Finding finding = finding_of("reversed_steps", right, comparison, certain);
  say(finding,
      certain ? "The poses of a or of b are summed up from inverted steps"
              : "The poses of a or of b may be summed up from inverted steps",
      "Sum up the motion from each pose to the next one: the transform that maps points of the next scan to "
      "the one before, not its inverse.",
      certain
          ? format(": the squared residuals are %.3g times smaller with the steps inverted.",
                   finding.improvement)
          : ": the motions agree as well with them inverted as with a sensor that is mounted back to front "
            "and upside down.");
  return finding;
}

Finding worded_rotations(const Explained& right, const Comparison& comparison, Side side) {
  const char which = side == Side::a ? 'a' : 'b';
  Finding finding = finding_of(std::string("axes_") + which, right, comparison, true);
  say(finding, format("The position and the rotation of %s do not belong together", mark(which)),
      format("Sum up the steps of %s with their rotations from each pose to the next one.", mark(which)),
      format(": with the rotation of each step inverted, the squared residuals are %.3g times smaller.",
             finding.improvement));
  return finding;
}

}  // namespace

std::vector<Finding> reversed_steps(const Evidence& evidence, const DiagnosisOptions& options,
                                    const ReversedStepsOptions& search) {
  const Explained& given = evidence.given.explained;
  if (std::min(evidence.streams.a.size(), evidence.streams.b.size()) < 2 ||
      given.motions.all.size() < options.motions.least)
    return {};
  const int stride = std::max(1, given.motions.stride / search.shorter);
  const Motions shorter =
      motions_of(evidence.instants, {}, {}, stride, options.motions.first_look, options.motions);
  const auto promising = [&](Side side, Reversed reversed) {
    return is_promising(shorter, side, reversed, options, search) ||
           is_promising(given.motions, side, reversed, options, search);
  };
  const auto better_then = [&](const Explained& right, const Comparison& comparison) {
    return explains(right, options) && better(comparison, options.gain, options) &&
           loss_in_metres(given, right) <= 0;
  };
  std::vector<Finding> findings;
  const bool flipped = explains(given, options) && like_mounting(given.fit.T, search);
  if (flipped || promising(Side::b, Reversed::step)) {
    const Explained right = with_right_steps(evidence, Side::b, Reversed::step, options);
    const Comparison comparison = compare(given, right);
    if (better_then(right, comparison))
      findings.push_back(worded_whole(right, comparison, true));
    else if (flipped && explains(right, options) && comparison.gain > -options.alike)
      findings.push_back(worded_whole(right, comparison, false));
  }
  std::vector<std::pair<double, Finding>> rotations;
  for (const Side side : {Side::b, Side::a}) {
    if (!promising(side, Reversed::rotation)) continue;
    const Explained right = with_right_steps(evidence, side, Reversed::rotation, options);
    const Comparison comparison = compare(given, right);
    if (better_then(right, comparison))
      rotations.emplace_back(comparison.gain, worded_rotations(right, comparison, side));
  }
  // steps of a few degrees hardly tell in which stream they are inverted
  double best = 0;
  for (const auto& [gain, finding] : rotations) best = std::max(best, gain);
  for (auto& [gain, finding] : rotations)
    if (gain >= best - options.alike) findings.push_back(std::move(finding));
  std::stable_sort(findings.begin(), findings.end(),
                   [](const Finding& x, const Finding& y) { return x.improvement > y.improvement; });
  return findings;
}

}  // namespace egocal::detail
