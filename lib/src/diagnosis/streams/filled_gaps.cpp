// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/filled_gaps.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/row_changes.hpp"
#include "diagnosis/streams/interpolated_stream.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "statistics/quantile.hpp"

namespace egocal::detail {

namespace {

/// Poses of a stream, on one line [s].
struct Line {
  double begin = 0, end = 0;
  bool turns = false;  ///< positions alone: the rotations are the sensor's own
};

bool pose_goes_on(const Bends& bends) {
  return !bends.pose.rests && bends.pose.bent < 1;
}

/// Whether the position goes on as it did last, or stays while the sensor turns.
bool position_goes_on(const Bends& bends) {
  return bends.position.rests ? !bends.rotation.rests : bends.position.bent < 1;
}

std::vector<Line> lines_in(const Trajectory& rows, const Times& times, const FilledGapsOptions& options) {
  std::vector<Line> lines;
  const std::size_t n = rows.size(), count = std::min(n, options.most), first = (n - count) / 2;
  std::size_t straight = 0;
  bool turns = false;
  for (std::size_t i = first + 1; i + 1 <= first + count; ++i) {
    const std::optional<Bends> bends = i + 1 < first + count ? bends_at(rows, i) : std::nullopt;
    if (bends && (pose_goes_on(*bends) || position_goes_on(*bends))) {
      ++straight;
      turns = turns || !pose_goes_on(*bends);
      continue;
    }
    if (straight >= options.least) lines.push_back({times[i - straight - 1], times[i], turns});
    straight = 0;
    turns = false;
  }
  if (lines.size() <= options.most_lines) return lines;
  const auto longer = [](const Line& x, const Line& y) { return x.end - x.begin > y.end - y.begin; };
  const auto earlier = [](const Line& x, const Line& y) { return x.begin < y.begin; };
  std::stable_sort(lines.begin(), lines.end(), longer);
  lines.resize(options.most_lines);
  std::sort(lines.begin(), lines.end(), earlier);
  return lines;
}

/// The first instant at this time or later.
std::size_t instant_at(const Instants& instants, double time) {
  std::size_t from = 0, to = instants.size();
  while (from < to) {
    const std::size_t middle = from + (to - from) / 2;
    if (instants.time(middle) < time)
      from = middle + 1;
    else
      to = middle;
  }
  return from;
}

struct PairOfMotions {
  Pose a, b;

  double length() const { return std::max(a.translation.norm(), b.translation.norm()); }
  double angle() const { return std::max(rotation_log(a.rotation).norm(), rotation_log(b.rotation).norm()); }
  /// Residual of the motions at the answer.
  Residual left(const Pose& T) const {
    const Pose rest = inverse(a * T) * (T * b);
    return {rotation_log(rest.rotation).norm(), rest.translation.norm()};
  }
};

PairOfMotions motion_between(const Instants& instants, std::size_t from, std::size_t to) {
  const PosePair begin = instants.at(from), end = instants.at(to);
  return {inverse(to_pose(begin.a)) * to_pose(end.a), inverse(to_pose(begin.b)) * to_pose(end.b)};
}

/// Usual residual of motions over as many instants that move as far and turn as far: others may have less to
/// leave. Empty where such motions are few.
std::optional<Residual> usual_of(const Instants& instants, std::size_t span, const PairOfMotions& motion,
                                 const Pose& T, const FilledGapsOptions& options) {
  std::vector<double> rotation, translation;
  const std::size_t each = (instants.size() + options.compared - 1) / options.compared;
  for (std::size_t i = 0; i + span < instants.size(); i += each) {
    const PairOfMotions here = motion_between(instants, i, i + span);
    if (here.length() < options.as_far * motion.length() || here.angle() < options.as_far * motion.angle())
      continue;
    const Residual left = here.left(T);
    rotation.push_back(left.rotation);
    translation.push_back(left.translation);
  }
  if (rotation.size() < options.fewest) return std::nullopt;
  return Residual{quantile(rotation, options.usual), quantile(translation, options.usual)};
}

/// Whether the motion from one instant to another contradicts the other stream, where others leave little.
bool motion_contradicts(const Instants& instants, std::size_t from, std::size_t to, bool turns, const Pose& T,
                        const FilledGapsOptions& options) {
  const PairOfMotions motion = motion_between(instants, from, to);
  const std::optional<Residual> usual = usual_of(instants, to - from, motion, T, options);
  if (!usual) return false;
  const Residual left = motion.left(T);
  const bool turns_otherwise =
      !turns && left.rotation > std::max(options.times * usual->rotation, options.least_left);
  return turns_otherwise || left.translation > std::max(options.times * usual->translation,
                                                        options.least_left * motion.length());
}

/// Whether one half of the line contradicts the other stream, and not because of a single wrong pose: neither
/// at its own end outside, nor in the middle.
bool line_contradicts(const Instants& instants, const Line& line, const Pose& T,
                      const FilledGapsOptions& options) {
  const std::size_t from = instant_at(instants, line.begin), to = instant_at(instants, line.end);
  if (to >= instants.size() || to < from + 2) return false;
  const std::size_t middle = from + (to - from) / 2;
  const auto motion = [&](std::size_t begin, std::size_t end) {
    return motion_contradicts(instants, begin, end, line.turns, T, options);
  };
  if (motion(from, middle) && (from == 0 || motion(from - 1, middle)) && motion(from, middle + 1))
    return true;
  return motion(middle, to) && (to + 1 >= instants.size() || motion(middle, to + 1)) &&
         motion(middle - 1, to);
}

}  // namespace

std::optional<Finding> filled_gaps(const Evidence& evidence, const DualQuaternion& T_a_b,
                                   const FilledGapsOptions& options) {
  const Pose T = to_pose(T_a_b);
  for (const Side side : {Side::b, Side::a}) {
    const Trajectory& rows = rows_of(evidence, side);
    const Times times(rows, evidence.streams.a.front().time_us,
                      side == Side::a ? ClockModel{} : evidence.clock);
    std::vector<Line> filled;
    for (const Line& line : lines_in(rows, times, options))
      if (line_contradicts(evidence.instants, line, T, options)) filled.push_back(line);
    if (filled.empty()) continue;
    const char which = side == Side::a ? 'a' : 'b';
    double seconds = 0;
    for (const Line& line : filled) seconds += line.end - line.begin;
    const std::string others =
        filled.size() > 1 ? format(", and %zu times more, %.1f s in all", filled.size() - 1, seconds) : "";
    Finding finding;
    finding.code = std::string("filled_") + which;
    finding.certain = true;
    finding.time = filled.front().begin;
    say(finding,
        format("From %.1f to %.1f s after the start%s, the positions of %s lie on a straight line, or stay, "
               "which the other sensor does not: they were filled in where %s had none",
               filled.front().begin, filled.front().end, others.c_str(), mark(which), mark(which)),
        format("Give the poses of %s as they were measured, without those that fill gaps.", mark(which)),
        ".");
    return finding;
  }
  return std::nullopt;
}

}  // namespace egocal::detail
