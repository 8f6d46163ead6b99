// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/lengths/not_a_move.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/lengths/part_of_other_scale.hpp"
#include "diagnosis/explanations/lengths/spread_motions.hpp"
#include "diagnosis/explanations/lengths/wandering_scale.hpp"
#include "diagnosis/motions/axes.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "diagnosis/mount/in_parts.hpp"
#include "diagnosis/mount/large_move.hpp"
#include "diagnosis/mount/mount.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/scale/estimate_scale.hpp"
#include "egocal/scale/scale_course.hpp"

namespace egocal::detail {

namespace {

using ScaleGuesses = std::vector<ScaleSolution>;

/// Poses of a part of the time.
Trajectory between(const Trajectory& trajectory, std::int64_t begin_us, std::int64_t end_us) {
  Trajectory result;
  for (const StampedPose& pose : trajectory)
    if (pose.time_us >= begin_us && pose.time_us < end_us) result.push_back(pose);
  return result;
}

std::optional<ScaleSolution> scale_of_all(const Trajectory& a, const Trajectory& b,
                                          const PairingOptions& pairing) {
  DriveScaleOptions options;
  options.scale.side = Side::b;
  return estimate_scale(a, b, pairing, options);
}

/// Motions of a part of the time; they are in its order.
std::span<const MotionPair> between(std::span<const MotionPair> motions, std::int64_t begin_us,
                                    std::int64_t end_us) {
  const auto first = std::partition_point(
      motions.begin(), motions.end(), [&](const MotionPair& motion) { return motion.begin_us < begin_us; });
  const auto last = std::partition_point(first, motions.end(),
                                         [&](const MotionPair& motion) { return motion.end_us < end_us; });
  return {first, last};
}

/// First guesses: one scale for the whole drive, and that of each part between the moves. Where a machine
/// mostly turns in place, a scale that changes spoils the extrinsic of the whole drive so far that its course
/// is not found from there; a part before or after the change has the right one.
/// motions: of a long drive; empty: all of them are looked at.
ScaleGuesses scales_of_b(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                         std::span<const MotionPair> motions, const std::vector<Finding>& moves) {
  ScaleGuesses guesses;
  const auto add = [&](const std::optional<ScaleSolution>& scale) {
    if (scale) guesses.push_back(*scale);
  };
  const bool all = motions.empty();
  add(all ? scale_of_all(a, b, pairing) : scale_of_b(motions, pairing.mode));
  if (moves.empty()) return guesses;
  const std::int64_t offset_us = to_microseconds(pairing.time_offset);
  std::int64_t from = a.front().time_us;
  for (std::size_t k = 0; k <= moves.size(); ++k) {
    std::int64_t to = a.back().time_us + 1;
    if (k < moves.size()) {
      if (!moves[k].time) continue;
      to = a.front().time_us + to_microseconds(*moves[k].time);
    }
    add(all ? scale_of_all(between(a, from, to), between(b, from - offset_us, to - offset_us), pairing)
            : scale_of_b(between(motions, from, to), pairing.mode));
    from = to;
  }
  return guesses;
}

/// Times are counted from origin_us.
std::string in_words(const ScaleCourse& course, std::int64_t origin_us) {
  constexpr std::size_t most = 4;  // a message is one line
  const auto seconds = [&](std::int64_t time_us) { return to_seconds(time_us - origin_us); };
  std::string text;
  for (std::size_t i = 0; i < std::min(most, course.segments.size()); ++i) {
    const ScaleSegment& segment = course.segments[i];
    text += format("%s%.4g", i > 0 ? ", " : "", segment.begin_scale);
    if (segment.end_scale != segment.begin_scale) text += format(" to %.4g", segment.end_scale);
    text += format(" from %.1f to %.1f s", seconds(segment.begin_us), seconds(segment.end_us));
  }
  if (course.segments.size() > most) text += format(" and %zu more", course.segments.size() - most);
  return text;
}

/// Whether sensors that move show more than one scale: of those that stand the noise has one.
bool changes_while_moving(const ScaleCourse& course, const Explained& given, std::int64_t origin_us) {
  const Motions moving = without_rest(given.motions, to_pose(given.fit.T));
  if (moving.all.size() == given.motions.all.size()) return true;
  std::vector<const ScaleSegment*> shown;
  for (const ScaleSegment& segment : course.segments) {
    const double begin = to_seconds(segment.begin_us - origin_us),
                 end = to_seconds(segment.end_us - origin_us);
    const auto within = [&](const Motion& motion) { return motion.time >= begin && motion.time < end; };
    const auto count = [&](const Motions& motions) {
      return std::count_if(motions.all.begin(), motions.all.end(), within);
    };
    if (2 * count(moving) > count(given.motions)) shown.push_back(&segment);
  }
  return std::any_of(shown.begin(), shown.end(), [&](const ScaleSegment* one) {
    return one->begin_scale != one->end_scale || one->begin_scale != shown.front()->begin_scale;
  });
}

/// Finding scale_change by a course of the scale of b; empty where the scale does not change, or where a
/// mount still moves. moved: whether a mount seems to move as given; where none does, the scales may leave
/// small moves, as each is wrong by a little, but must explain more than those.
std::optional<Finding> changing_scale(const PairingOptions& pairing, const Evidence& evidence,
                                      const Answered& answered, const ScaleCourse& course, bool moved,
                                      const DiagnosisOptions& options) {
  const Trajectory& a = evidence.streams.a;
  const Trajectory& b = evidence.streams.b;
  if (!course.changes() || !changes_while_moving(course, evidence.given.explained, a.front().time_us))
    return std::nullopt;
  const Trajectory followed = scaled(b, course);
  const Instants instants = synchronised(a, followed, evidence.clock, pairing.max_gap, 1, options.motions);
  const std::vector<Finding> left = moved_mount(instants, answered, options).findings;
  if ((moved && !left.empty()) || large_move(instants, evidence.stride, options)) return std::nullopt;
  Explained explained;
  explained.motions = motions_of(instants, {}, {}, evidence.stride, options.motions.most, options.motions);
  if (explained.motions.all.empty()) return std::nullopt;
  explained.fit = robust_fit(explained.motions, options.fit);
  const double gain = compare(evidence.given.explained, explained).gain;
  if (!(gain > options.least_gain) ||
      (!left.empty() && !(gain > compare(explained, in_parts(explained.motions, left, options)).gain)))
    return std::nullopt;
  const std::int64_t origin_us = a.front().time_us;
  Finding finding;
  finding.code = "scale_change";
  // noise that wanders makes lengths err for a while, as it does everything else: of that a scale leaves most
  finding.certain = gain >= options.gain;
  finding.improvement = std::exp(gain);
  const ScaleSegment& first = course.segments.front();
  const bool drifts = course.segments.size() == 1;
  finding.time = to_seconds((drifts ? first.begin_us : first.end_us) - origin_us);
  finding.T_a_b = to_pose(explained.fit.T);
  say(finding,
      std::string("The lengths of {b} ") + (finding.certain ? "must" : "may have to") +
          " be multiplied by a factor that changes along the drive: " + in_words(course, origin_us) +
          (finding.certain ? "" : ". Noise that wanders for as long may look the same") +
          (left.empty() ? ". With these the mounting does not move." : "."),
      "{solve}--scale-b auto finds the factors; --scale auto where {b} is in metres.");
  return finding;
}

}  // namespace

std::optional<Finding> changing_scale(const PairingOptions& pairing, const Evidence& evidence,
                                      const Answered& answered, const DiagnosisOptions& options,
                                      const std::vector<Finding>& moves) {
  const Trajectory &a = evidence.streams.a, &b = evidence.streams.b;
  std::vector<MotionPair> motions;  // all those of a long drive would take longer than all the rest
  if (is_long(evidence.instants))
    motions = spread_motions(evidence.instants, a.front().time_us, pairing, options.motions);
  std::optional<Finding> best;
  for (const ScaleSolution& guess : scales_of_b(a, b, pairing, motions, moves)) {
    const ScaleCourse course = motions.empty() ? find_scale_course(a, b, pairing, guess, Side::b)
                                               : find_scale_course(motions, pairing.mode, guess, Side::b);
    std::optional<Finding> found =
        changing_scale(pairing, evidence, answered, course, !moves.empty(), options);
    if (found && (!best || found->improvement > best->improvement)) best = std::move(found);
  }
  return best;
}

namespace {

/// No mount moves where both streams are read like this, and one extrinsic fits about as well as one a part.
bool explained_by_reading(const PoseReading& of_both, const Evidence& evidence,
                          const std::vector<Finding>& moves, const Answered& answered,
                          const DiagnosisOptions& options) {
  const Motions motions =
      motions_of(evidence.instants, of_both, of_both, evidence.stride, options.motions.most, options.motions);
  if (motions.all.empty() || !moved_mount(evidence.instants, answered, options, of_both).findings.empty())
    return false;
  const Explained both{motions, robust_fit(motions, options.fit)};
  const Explained parts = in_parts(evidence.given.explained.motions, moves, options);
  return compare(parts, both).gain > -options.gain;
}

/// One extrinsic for each part explains the motions of the drive clearly better than this course of the scale
/// of b does: a copy of the poses at its scales would show the mount that moves as well.
bool moves_beside(const ScaleCourse& course, const Evidence& evidence, const std::vector<Finding>& moves,
                  const DiagnosisOptions& options) {
  const Motions& given = evidence.given.explained.motions;
  const std::int64_t origin_us = evidence.streams.a.front().time_us;
  Explained followed{given, {}};
  for (Motion& motion : followed.motions.all) {
    const double scale = course.at(origin_us + to_microseconds(motion.time));
    motion.t_b *= scale;
    motion.b.dual *= scale;
  }
  followed.fit = robust_fit(followed.motions, options.fit);
  return better(compare(followed, in_parts(given, moves, options)), options.gain, options);
}

/// No mount moves at a scale that wanders by as little as those of odometries do.
bool moves_with_the_scale(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                          const std::vector<Finding>& moves, const DiagnosisOptions& options) {
  const Trajectory &a = evidence.streams.a, &b = evidence.streams.b;
  const std::optional<ScaleCourse> course =
      wandering_scale(evidence.given.explained.motions, a.front().time_us, moves, options);
  if (!course || (is_long(evidence.instants) && moves_beside(*course, evidence, moves, options)))
    return false;
  const Trajectory followed = scaled(b, *course);
  const Instants instants = synchronised(a, followed, evidence.clock, pairing.max_gap, 1, options.motions);
  return moved_mount(instants, answered, options).findings.empty() &&
         !large_move(instants, evidence.stride, options);
}

/// What seems to move once, because the lengths of b after that are in another unit.
std::optional<Finding> in_another_unit(const Evidence& evidence, const std::vector<Finding>& moves,
                                       const DiagnosisOptions& options) {
  if (!one_move(moves) || !moves.front().time) return std::nullopt;
  std::optional<Finding> scale =
      part_of_other_scale(evidence.given.explained, *moves.front().time, INFINITY, options);
  const double least = gain_of_parts(evidence, moves, options) - options.alike;
  return scale && std::log(scale->improvement) > least ? scale : std::nullopt;
}

}  // namespace

double gain_of_parts(const Evidence& evidence, const std::vector<Finding>& moves,
                     const DiagnosisOptions& options) {
  const Explained& given = evidence.given.explained;
  return compare(given, in_parts(given.motions, moves, options)).gain;
}

std::vector<PoseReading> readings_of_both(const std::vector<Finding>& findings) {
  std::vector<PoseReading> readings;
  for (const Finding& finding : findings) {
    if (finding.code == "inverted_both") readings.emplace_back().invert = true;
    if (finding.code != "axes_both" || finding.certain) continue;
    const std::vector<PoseReading> inverse = inverse_rotation_readings();
    readings.insert(readings.end(), inverse.begin(), inverse.end());
  }
  return readings;
}

std::optional<Finding> inverse_rotations_instead(const Evidence& evidence, const std::vector<Finding>& moves,
                                                 const Answered& answered, const DiagnosisOptions& options) {
  if (moves.empty()) return std::nullopt;
  const CommonAxesOptions least;
  const Explained parts = in_parts(evidence.given.explained.motions, moves, options);
  const Explained& given = evidence.given.explained;
  for (const PoseReading& reading : inverse_rotation_readings()) {
    Explanation here = explained(evidence, "axes_both", reading, reading, options);
    if (here.explained.motions.all.empty() || !explains(here.explained, options)) continue;
    const Comparison comparison = compare(given, here.explained);
    if (!better(comparison, least.gain_beside_move, least.possible_sigmas) ||
        loss_in_metres(given, here.explained) > -least.gain_beside_move_in_metres ||
        !(compare(parts, here.explained).gain > -options.gain) ||
        !moved_mount(evidence.instants, answered, options, reading).findings.empty())
      continue;
    return worded_reading(finding_of(here, comparison, false), here.read_a, here.read_b);
  }
  return std::nullopt;
}

std::vector<Finding> moves_or_else(std::vector<Finding> moves, const PairingOptions& pairing,
                                   const Evidence& evidence, const Answered& answered,
                                   const std::vector<PoseReading>& of_both, const DiagnosisOptions& options) {
  if (moves.empty()) return moves;
  std::optional<Finding> scale = changing_scale(pairing, evidence, answered, options, moves);
  // a sensor that was turned aside goes another way by its own axes: that is a scale only as far as it fits
  if (scale && std::all_of(moves.begin(), moves.end(),
                           [&](const Finding& move) { return move.improvement <= scale->improvement; }))
    return {*std::move(scale)};
  if (std::optional<Finding> unit = in_another_unit(evidence, moves, options)) return {*std::move(unit)};
  if (moves_with_the_scale(pairing, evidence, answered, moves, options)) return {};
  if (std::any_of(of_both.begin(), of_both.end(), [&](const PoseReading& reading) {
        return explained_by_reading(reading, evidence, moves, answered, options);
      }))
    for (Finding& move : moves) move.certain = false;
  return moves;
}

}  // namespace egocal::detail
