// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/turning_alike.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/in_words.hpp"

namespace egocal::detail {

namespace {

/// Whether more than half of the poses had no neighbours to interpolate between.
bool most_in_gaps(const PairingCounts& counts) {
  std::uint64_t poses = counts.synchronised;
  for (const std::uint64_t rejected : counts.rejected) poses += rejected;
  return 2 * counts.rejected[static_cast<std::size_t>(Rejection::gap)] > poses;
}

}  // namespace

double turning_correlation(const Motions& motions, double part) {
  std::vector<std::size_t> order(motions.all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto count = static_cast<std::size_t>(part * static_cast<double>(order.size()));
  if (count < order.size()) {
    const auto difference = [&](std::size_t i) {
      return std::abs(motions.all[i].angle_a - motions.all[i].angle_b);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t k) { return difference(i) < difference(k); });
  }
  double n = 0, sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = motions.all[order[i]].angle_a, y = motions.all[order[i]].angle_b;
    n += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    syy += y * y;
    sxy += x * y;
  }
  const double variance = (sxx - sx * sx / n) * (syy - sy * sy / n);
  return variance > 0 ? (sxy - sx * sy / n) / std::sqrt(variance) : 0;
}

Finding unrelated(double correlation) {
  return certain_finding(
      "unrelated",
      format("The two streams do not turn together (correlation %.2f): they are not of one rigid "
             "body, or not of one drive.",
             correlation),
      "Check that both files are of the same drive, that both sensors are rigidly mounted, and that the "
      "rotations of both have the units and the order that their format says.");
}

Finding too_little_motion(std::size_t motions, const DiagnosisOptions& options) {
  return certain_finding("too_little_motion",
                         motions < options.motions.least
                             ? "Only " + counted(motions, "motion") + ": too few to judge the fit."
                             : "The sensors hardly turn: an extrinsic cannot be found from this drive.",
                         "Record a longer drive with turns in different directions.");
}

void name_longest_gap(const PairingCounts& counts, std::vector<Finding>& findings) {
  if (!most_in_gaps(counts)) return;
  for (Finding& finding : findings) {
    if (finding.code != "too_little_motion") continue;
    const std::string said =
        finding.message +
        format(" %.0f poses were rejected, as their neighbours are further apart than is interpolated over.",
               static_cast<double>(counts.rejected[static_cast<std::size_t>(Rejection::gap)]));
    say(finding, said,
        "If the streams are that slow, {solve}--max-gap SECONDS allows more; otherwise record without gaps.",
        "");
  }
}

Finding turning_in_noise(double correlation) {
  return certain_finding(
      "too_little_motion",
      format("The streams travel alike but do not turn alike (correlation %.2f): the drive turns by "
             "less than the noise of the rotations.",
             correlation),
      "Record a drive with sharper turns in different directions, or improve the rotations.");
}

}  // namespace egocal::detail
