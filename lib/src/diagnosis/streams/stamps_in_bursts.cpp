// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/stamps_in_bursts.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/microseconds.hpp"

namespace egocal::detail {

namespace {

/// Way along the motion around it, of the steps within bursts and of the others: sums.
struct WayInBursts {
  double within = 0, between = 0;
};

/// Way of the positions, or of the rotations, within bursts and between them. step(i), a vector in the world,
/// leads from pose i to the next one.
template <typename Step>
WayInBursts way_of(const std::vector<bool>& within, std::size_t first, std::size_t reach, const Step& step) {
  WayInBursts way;
  for (std::size_t i = first; i < first + within.size(); ++i) {
    Eigen::Vector3d around = Eigen::Vector3d::Zero();
    for (std::size_t k = i - reach; k <= i + reach; ++k)
      if (k != i) around += step(k);
    const double length = around.norm();
    if (!(length > 0)) continue;
    (within[i - first] ? way.within : way.between) += step(i).dot(around) / length;
  }
  return way;
}

/// Which of the steps from first to end are within bursts; empty where the stamps come in none.
std::vector<bool> steps_in_bursts(const Trajectory& poses, std::size_t begin, std::size_t n,
                                  std::size_t first, std::size_t end, const BurstOptions& options) {
  const auto seconds = [&](std::size_t from, std::size_t to) {
    return to_seconds(poses[to].time_us - poses[from].time_us);
  };
  std::vector<bool> within;
  std::size_t count = 0, run = 0;
  for (std::size_t i = first; i < end; ++i) {
    const std::size_t from = i - std::min(i - begin, options.reach_of_time),
                      to = std::min(i + 1 + options.reach_of_time, begin + n - 1);
    within.push_back(seconds(i, i + 1) * static_cast<double>(to - from) < options.within * seconds(from, to));
    run = within.back() ? run + 1 : 0;
    if (run > options.longest) return {};
    count += within.back();
  }
  const bool in_bursts = static_cast<double>(count) >= options.part * static_cast<double>(within.size()) &&
                         count < within.size();
  return in_bursts ? within : std::vector<bool>{};
}

}  // namespace

double motion_in_bursts(const Trajectory& poses, const BurstOptions& options) {
  const std::size_t n = std::min(poses.size(), options.most), begin = (poses.size() - n) / 2;
  if (n < std::max(options.least, 3 * options.reach)) return 0;
  const std::size_t first = begin + options.reach, end = begin + n - 1 - options.reach;
  const std::vector<bool> within = steps_in_bursts(poses, begin, n, first, end, options);
  if (within.empty()) return 0;
  const auto count = static_cast<double>(std::count(within.begin(), within.end(), true)),
             all = static_cast<double>(within.size());
  std::vector<Eigen::Vector3d> moved, turned;
  Pose last = to_pose(poses[begin].pose);
  for (std::size_t i = begin; i + 1 < begin + n; ++i) {
    const Pose next = to_pose(poses[i + 1].pose);
    moved.emplace_back(next.translation - last.translation);
    turned.emplace_back(rotation_log(next.rotation * last.rotation.conjugate()));
    last = next;
  }
  double farthest = 0;  // from one
  for (const std::vector<Eigen::Vector3d>& steps : {moved, turned}) {
    const WayInBursts way =
        way_of(within, first, options.reach, [&](std::size_t i) { return steps[i - begin]; });
    if (way.within == 0 && way.between == 0) continue;  // a stream that never turns, or never moves
    const double in = way.within / count, between = way.between / (all - count);
    if (!(between > 0 && in > 0)) return 0;
    const double here = in / between;
    if (farthest == 0 || std::abs(std::log(here)) > std::abs(std::log(farthest))) farthest = here;
  }
  return farthest;
}

std::vector<Finding> stamps_in_bursts(const Trajectory& a, const Trajectory& b, const Fit& fit,
                                      const BurstOptions& options) {
  std::vector<Finding> findings;
  if (fit.translation_relative_median <= options.agreement) return findings;
  for (const char which : {'a', 'b'}) {
    const double way = motion_in_bursts(which == 'a' ? a : b, options);
    if (!(way >= options.alike && way <= 1 / options.alike)) continue;
    Finding finding;
    finding.code = std::string("stamps_") + which;
    finding.certain = true;
    say(finding,
        format("The stamps of %s come in bursts, and it moves %.2g times as far within one as between two: "
               "its poses waited in a buffer, and the stamps are those of their arrival.",
               mark(which), way),
        format("Stamp the poses of %s when they are measured.", mark(which)));
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace egocal::detail
