// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/mount/large_move.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/motions/correction.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "diagnosis/mount/division.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/statistics/median.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// Typical residual of one part at an answer, as a part of the typical motion.
double typical_at(const Motions& part, const DualQuaternion& T) {
  return std::sqrt(evaluated(part, T).typical);
}

/// Half of the motions of this part of the drive are not much smaller than usual.
bool moves(const Motions& part, double least) {
  std::vector<double> sizes;
  for (const Motion& motion : part.all) {
    const auto size = [](double a, double b, double usual) { return usual > 0 ? std::max(a, b) / usual : 0; };
    sizes.push_back(std::max(size(motion.angle_a, motion.angle_b, part.rotation),
                             size(motion.t_a.norm(), motion.t_b.norm(), part.translation)));
  }
  return !sizes.empty() && median(std::move(sizes)) > least;
}

bool contradict(const Motions& before, const Motions& after, const Division& found,
                const LargeMoveOptions& large) {
  const auto contradicts = [&](const Motions& part, const DualQuaternion& own, const DualQuaternion& other) {
    const double there = typical_at(part, other);
    return there > large.contradicts &&
           typical_at(part, own) < std::min(large.own * there, large.contradicts);
  };
  return contradicts(before, found.before.T, found.after.T) &&
         contradicts(after, found.after.T, found.before.T);
}

/// Whether one answer suits both sides hardly worse than their own ones do. A side may leave open what the
/// other one shows (straight on first, turns on the spot later); its answer contradicts the other side by
/// chance.
bool suits_both(const Motions& before, const Motions& after, const Division& found,
                const DualQuaternion& common, const LargeMoveOptions& large) {
  const auto suits = [&](const Motions& part, const DualQuaternion& own) {
    return typical_at(part, own) >= large.own * typical_at(part, common);
  };
  return suits(before, found.before.T) && suits(after, found.after.T);
}

/// Whether both sides contradict each other without the seconds around the change as well: a correction of an
/// odometry ends, and leaves the mounting as it was. Where a side has fewer seconds left, whether a mounting
/// explains both.
bool contradict_around(const Motions& motions, const Division& found, double time, double motion_seconds,
                       const DiagnosisOptions& options, const LargeMoveOptions& large) {
  const double left_out = CorrectionOptions{}.seconds + 0.5 * motion_seconds;
  std::size_t end = 0, begin = 0;
  while (end < motions.all.size() && motions.all[end].time <= time - left_out) ++end;
  for (begin = end; begin < motions.all.size() && motions.all[begin].time < time + left_out;) ++begin;
  const auto seconds = [&](std::size_t first, std::size_t last) {
    return first < last ? motions.all[last - 1].time - motions.all[first].time + motion_seconds : 0;
  };
  if (std::min(seconds(0, end), seconds(begin, motions.all.size())) < CorrectionOptions{}.seconds) {
    const Stretch before{part_of(motions, 0, found.at), found.before.T},
        after{part_of(motions, found.at, motions.all.size()), found.after.T};
    return !unexplained_beside(before, after) && !unexplained_beside(after, before);
  }
  const Motions before = part_of(motions, 0, end), after = part_of(motions, begin, motions.all.size());
  Division around = found;
  around.before = robust_fit(before, options.fit);
  around.after = robust_fit(after, options.fit);
  return contradict(before, after, around, large);
}

Finding worded(const Division& found, double time, const Comparison& comparison, bool metres) {
  const Vector6d change = frame_a_difference(found.before.T, found.after.T);
  Finding finding;
  finding.code = "mount_moved";
  finding.certain = true;
  finding.time = time;
  finding.improvement = std::exp(comparison.gain);
  finding.T_a_b = to_pose(found.after.T);
  const double turned = change.tail<3>().norm() * degrees_per_radian;
  const std::string size = turned < 1 ? "shifted by " + length_in_words(change.head<3>().norm(), metres)
                                      : format("turned by %.0f deg", turned);
  finding.message = format(
      "From about %.1f s after the start on, another mounting explains the motions: it is %s. A sensor was "
      "moved, or its poses are in other axes from then on.",
      time, size.c_str());
  finding.remedy = format("Calibrate the drive before and after %.1f s separately.", time);
  return finding;
}

/// Single steps show the time best: longer motions that cross it fit neither answer.
double time_of(const Division& division, const Instants& instants, const Pose& whole,
               const DiagnosisOptions& options) {
  const Motions steps =
      without_rest(motions_of(instants, {}, {}, 1, options.motions.most, options.motions), whole);
  if (steps.all.empty()) return 0;
  const double floor = 0.25 * std::min(evaluated(steps, division.before.T).typical,
                                       evaluated(steps, division.after.T).typical);
  const std::size_t place = best_place(steps, division, 0, floor);
  return steps.all[std::min(place, steps.all.size() - 1)].time;
}

/// Finding of a large move by motions of one length.
std::optional<Finding> move_of(const Instants& instants, int stride, const DiagnosisOptions& options,
                               const LargeMoveOptions& large) {
  const Motions all = motions_of(instants, {}, {}, stride, options.motions.most, options.motions);
  if (all.all.empty()) return std::nullopt;
  const RobustFit of_all = robust_fit(all, options.fit);
  // while the sensors stand only noise moves, which has an answer of its own
  const Motions motions = without_rest(all, to_pose(of_all.T));
  const std::size_t n = motions.all.size();
  const std::size_t margin = large.least_blocks * n / motions.blocks;
  if (n < 2 * margin || margin == 0) return std::nullopt;
  const RobustFit whole = n < all.all.size() ? robust_fit(motions, options.fit) : of_all;
  std::optional<Division> divided = best_division(motions, whole, margin, large.places, options.fit);
  if (!divided) return std::nullopt;
  const Division& best = *divided;
  const Motions before = part_of(motions, 0, best.at), after = part_of(motions, best.at, n);
  if (!contradict(before, after, best, large) || suits_both(before, after, best, whole.T, large))
    return std::nullopt;
  const double time = time_of(best, instants, to_pose(whole.T), options);
  // on either side as many motions that share no time, which moved
  const double least_seconds = static_cast<double>(large.least_blocks) * stride * instants.period;
  if (std::min(time - motions.all.front().time, motions.all.back().time - time) < least_seconds)
    return std::nullopt;
  if (!contradict_around(motions, best, time, stride * instants.period, options, large)) return std::nullopt;

  return worded(best, time, compare({motions, whole}, in_two(motions, best)),
                options.unit == LengthUnit::metres);
}

}  // namespace

std::optional<Finding> large_move(const Instants& instants, int stride, const DiagnosisOptions& options,
                                  const LargeMoveOptions& large) {
  std::optional<Finding> best;
  for (const int length : {stride, std::max(1, stride / 4)}) {
    std::optional<Finding> found = move_of(instants, length, options, large);
    if (found && (!best || found->improvement > best->improvement)) best = std::move(found);
  }
  return best;
}

std::optional<UnexplainedPart> unexplained_part(const Motions& motions, const DualQuaternion& T_a_b,
                                                const LargeMoveOptions& large) {
  const std::size_t windows = large.windows;
  const std::size_t n = motions.all.size();
  if (n < 4 * windows) return std::nullopt;
  std::vector<double> misfits, sorted;
  for (std::size_t w = 0; w < windows; ++w) {
    const Motions window = part_of(motions, w * n / windows, (w + 1) * n / windows);
    // while the sensors stand only wrong poses move
    misfits.push_back(moves(window, large.least_motion) ? typical_at(window, T_a_b) : 0);
    if (misfits.back() > 0) sorted.push_back(misfits.back());
  }
  if (sorted.empty()) return std::nullopt;
  std::sort(sorted.begin(), sorted.end());
  const double explained = std::max(sorted[sorted.size() / 6], 1e-3);
  const double limit = std::max(2 * large.contradicts, explained / large.own);
  const auto is_bad = [&](double misfit) { return misfit > limit; };
  const auto bad = static_cast<std::size_t>(std::count_if(misfits.begin(), misfits.end(), is_bad));
  const double part = static_cast<double>(bad) / static_cast<double>(windows);
  if (part < large.least_part || part > large.most_part) return std::nullopt;
  // one run, except for one window
  const auto first = std::find_if(misfits.begin(), misfits.end(), is_bad);
  const auto last = std::find_if(misfits.rbegin(), misfits.rend(), is_bad).base();
  if (static_cast<std::size_t>(last - first) > bad + 1) return std::nullopt;
  const auto time = [&](std::ptrdiff_t window) {
    return motions.all[std::min(n - 1, static_cast<std::size_t>(window) * n / windows)].time;
  };
  return UnexplainedPart{time(first - misfits.begin()), time(last - misfits.begin())};
}

}  // namespace egocal::detail
