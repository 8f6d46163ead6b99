// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration/no_motions.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "egocal/calibrate.hpp"
#include "egocal/in_words.hpp"
#include "egocal/microseconds.hpp"
#include "pairing/offset/turning.hpp"

namespace egocal::detail {

namespace {

/// Streams of one drive hardly differ more in length; other units of time differ by a thousand.
constexpr double other_unit = 100;  // limit of a hint

/// Says where the times are in other units, or of other clocks, such as the time since the start of a log
/// beside that since 1970.
std::string times_in_words(const Trajectory& a, const Trajectory& b) {
  if (a.empty() || b.empty()) return "";
  const auto lasts = [](const Trajectory& x) {
    return static_cast<double>(x.back().time_us) - static_cast<double>(x.front().time_us);
  };
  const double ratio = lasts(b) / lasts(a);
  if (lasts(a) > 0 && lasts(b) > 0 && !(ratio < other_unit && ratio > 1 / other_unit)) {
    char text[128];
    std::snprintf(text, sizeof text,
                  "; %s lasts %.0f times as long: multiply its times if they are in another unit",
                  ratio > 1 ? "{b}" : "{a}", std::max(ratio, 1 / ratio));
    return text;
  }
  if (a.front().time_us <= b.back().time_us && b.front().time_us <= a.back().time_us) return "";
  return "; their times do not overlap: {solve}--time-offset auto if they are of one drive";
}

/// Says where the streams are too slow for the longest gap that is interpolated over, and that left no
/// motions.
std::string gaps_in_words(const Trajectory& a, const Trajectory& b, const PairingCounts& counts,
                          double max_gap) {
  if (counts.rejected[static_cast<std::size_t>(Rejection::gap)] == 0 || a.size() < 2 || b.size() < 2)
    return "";
  const double step_a = to_seconds(median_period_us(a)), step_b = to_seconds(median_period_us(b));
  if (!(std::min(step_a, step_b) > max_gap)) return "";
  char text[192];
  std::snprintf(
      text, sizeof text,
      "; the median time between poses is %.3g s in {a} and %.3g s in {b}, but nothing is interpolated "
      "over more than %.3g s: {solve}--max-gap SECONDS allows more",
      step_a, step_b, max_gap);
  return text;
}

/// A pose that is computed once a second and sent ten times, where that left no motions: the repeats are
/// rejected, and the new ones have no neighbour.
std::string repeats_in_words(const Trajectory& a, const Trajectory& b, const PairingCounts& counts) {
  if (counts.rejected[static_cast<std::size_t>(Rejection::frozen)] == 0) return "";
  const auto repeats = [](const StampedPose& x, const StampedPose& y) {
    return x.pose.real == y.pose.real && x.pose.dual == y.pose.dual;
  };
  std::string text;
  for (const auto& [name, stream] : {std::pair("{a}", &a), std::pair("{b}", &b)}) {
    std::size_t differ = 1, newest = 0;
    for (std::size_t i = 1; i < stream->size(); ++i) {
      if (repeats((*stream)[i - 1], (*stream)[i])) continue;
      ++differ;
      newest = i;
    }
    if (2 * differ > stream->size()) continue;  // as many are whole motions, and reject none of the others
    const double lasts = seconds_between(stream->front().time_us, (*stream)[newest].time_us);
    char line[256];
    if (differ == 1)
      std::snprintf(line, sizeof line,
                    "; the poses of %s are all the same while the other sensor moves: it does not work, or "
                    "other columns are its poses",
                    name);
    else
      std::snprintf(
          line, sizeof line,
          "; %s repeats its poses: of its %zu only %zu differ from the one before, one every %.3g s. "
          "Keep the first of each and leave out its repeats, or record the odometry before it is "
          "sent again at a fixed rate",
          name, stream->size(), differ, lasts / static_cast<double>(differ - 1));
    text += line;
  }
  return text;
}

}  // namespace

std::string no_motions_in_words(const Trajectory& a, const Trajectory& b, const PairingCounts& counts,
                                double max_gap) {
  return "no motion pairs; {a}: " + span_in_words(a) + ", {b}: " + span_in_words(b) + "; " +
         rejections_in_words(counts) + times_in_words(a, b) + gaps_in_words(a, b, counts, max_gap) +
         repeats_in_words(a, b, counts);
}

}  // namespace egocal::detail
