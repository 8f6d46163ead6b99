// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/part_of_other_scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Motions [first, last) of the drive.
struct Run {
  std::size_t first = 0, last = 0;
  bool has(std::size_t i) const { return i >= first && i < last; }
};

Run between(const Motions& motions, double begin, double end) {
  Run run;
  while (run.first < motions.all.size() && motions.all[run.first].time < begin) ++run.first;
  run.last = run.first;
  while (run.last < motions.all.size() && motions.all[run.last].time < end) ++run.last;
  return run;
}

Motions without(const Motions& motions, const Run& run) {
  Motions rest = motions;
  rest.all.clear();
  for (std::size_t i = 0; i < motions.all.size(); ++i)
    if (!run.has(i)) rest.all.push_back(motions.all[i]);
  measure_sizes(rest);
  return rest;
}

/// What b must have moved by, in its own frame, if the extrinsic is right [m].
Eigen::Vector3d expected_of_b(const Motion& motion, const Pose& T) {
  return T.rotation.conjugate() * (motion.R_a * T.translation + motion.t_a - T.translation);
}

/// The factor that most motions of a run agree on; 0 where b does not move.
double factor_of(const Motions& motions, const Run& run, const Pose& T) {
  std::vector<double> factors;
  for (std::size_t i = run.first; i < run.last; ++i) {
    const double squared = motions.all[i].t_b.squaredNorm();
    if (squared > 0) factors.push_back(expected_of_b(motions.all[i], T).dot(motions.all[i].t_b) / squared);
  }
  return factors.empty() ? 0 : median(std::move(factors));
}

/// Moves both ends to where the factor begins and ends to fit better than none.
Run with_exact_ends(const Motions& motions, Run run, double factor, const Pose& T) {
  const auto fits = [&](std::size_t i) {
    const Eigen::Vector3d expected = expected_of_b(motions.all[i], T), &measured = motions.all[i].t_b;
    return (expected - factor * measured).norm() < (expected - measured).norm();
  };
  while (run.first > 0 && fits(run.first - 1)) --run.first;
  while (run.first < run.last && !fits(run.first)) ++run.first;
  while (run.last < motions.all.size() && fits(run.last)) ++run.last;
  while (run.last > run.first && !fits(run.last - 1)) --run.last;
  return run;
}

/// The explanation for the motions of a run alone: in the rest there is nothing to gain.
Explained within(const Explained& explained, const Run& run) {
  Explained part{part_of(explained.motions, run.first, run.last), explained.fit};
  const std::size_t all = explained.motions.all.size();
  part.motions.blocks = std::max<std::size_t>(1, explained.motions.blocks * (run.last - run.first) / all);
  part.fit.squares.assign(explained.fit.squares.begin() + static_cast<std::ptrdiff_t>(run.first),
                          explained.fit.squares.begin() + static_cast<std::ptrdiff_t>(run.last));
  return part;
}

}  // namespace

std::optional<Finding> part_of_other_scale(const Explained& given, double begin, double end,
                                           const DiagnosisOptions& options,
                                           const PartOfOtherScaleOptions& part) {
  const Motions& motions = given.motions;
  Run run = between(motions, begin, end);
  const std::size_t count = run.last - run.first;
  if (count == 0 || motions.all.size() - count < options.motions.least) return std::nullopt;
  const Pose T = to_pose(robust_fit(without(motions, run), options.fit).T);
  const double factor = factor_of(motions, run, T);
  if (!(factor > 0) || std::abs(std::log(factor)) < std::log(part.least)) return std::nullopt;
  run = with_exact_ends(motions, run, factor, T);
  Explained here{motions, {}};
  for (std::size_t i = run.first; i < run.last; ++i) {
    Motion& motion = here.motions.all[i];
    motion.t_b *= factor;
    motion.b.dual *= factor;
  }
  measure_sizes(here.motions);
  here.fit = robust_fit(here.motions, options.fit);
  const Comparison comparison = compare(given, here);
  if (!explains(here, options) ||
      !better(compare(within(given, run), within(here, run)), options.gain, options))
    return std::nullopt;
  const double from = motions.all[run.first].time, to = motions.all[run.last - 1].time;
  Finding finding;
  finding.code = "scale_change";
  finding.certain = true;
  say(finding,
      format("From %.0f to %.0f s after the start the lengths of %s must be multiplied by %.4g, those of the "
             "rest by 1",
             from, to, mark('b'), factor),
      format("Write all poses of %s in one unit; where an odometry lost its scale there, use the rest of the "
             "drive.",
             mark('b')),
      ": that part is in another unit, or the odometry of one sensor lost its scale there.");
  finding.improvement = std::exp(comparison.gain);
  finding.time = from;
  finding.T_a_b = to_pose(here.fit.T);
  return finding;
}

}  // namespace egocal::detail
