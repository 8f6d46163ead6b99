// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/late_positions.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/motions/changed_motions.hpp"
#include "diagnosis/motions/speeds.hpp"
#include "diagnosis/motions/stillest_point.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

using Eigen::Vector3d;
using Changes = std::vector<Vector3d>;

/// The instant nearest to a time [s].
std::size_t nearest(const Instants& instants, double time) {
  std::size_t from = 0, to = instants.size();  // the first one after it is in [from, to]
  while (from < to) {
    const std::size_t middle = from + (to - from) / 2;
    if (instants.time(middle) > time)
      to = middle;
    else
      from = middle + 1;
  }
  if (from == 0) return 0;
  if (from == instants.size()) return from - 1;
  return instants.time(from) - time < time - instants.time(from - 1) ? from : from - 1;
}

/// What a delay adds to the translation of each motion, in the frame of its begin: [m], and what a second
/// more of it adds [m/s].
struct OfDelay {
  Changes added, of_a_second;
};

/// The positions at a later time are those of the instant nearest to it, moved on by its speed: over half a
/// second a person's speed is another one. Positions between two rows would be their mean, which has less
/// noise and fits better for that alone.
OfDelay of_delay(const Instants& instants, const Motions& motions, const std::vector<std::size_t>& begins,
                 Side side, double delay, const LatePositionsOptions& late) {
  const Speeds speeds(instants, late.least_span, late.most_instants);
  const auto span = static_cast<std::size_t>(motions.stride);
  const auto moved = [&](std::size_t i) {
    const double time = instants.time(i) + delay;
    const std::size_t near = nearest(instants, time);
    const Vector3d speed = speeds.at(near, side);
    Vector3d added = (time - instants.time(near)) * speed;
    if (near != i) added += speeds.position(near, side) - speeds.position(i, side);
    return std::pair(added, speed);
  };
  OfDelay result;
  for (const std::size_t i : begins) {
    const auto [from, speed_from] = moved(i);
    const auto [to, speed_to] = moved(i + span);
    const PosePair begin = instants.at(i);
    const Eigen::Matrix3d into_begin = rotation_of(side == Side::a ? begin.a : begin.b).transpose();
    result.added.emplace_back(into_begin * (to - from));
    result.of_a_second.emplace_back(into_begin * (speed_to - speed_from));
  }
  return result;
}

LatePositions fitted(const Instants& instants, const Explained& given, const std::vector<std::size_t>& begins,
                     Side side, const DiagnosisOptions& options, const LatePositionsOptions& tuning) {
  LatePositions late{side, 0, given, {}};
  OfDelay here = of_delay(instants, given.motions, begins, side, 0, tuning);
  for (int round = 0; round < options.fit.rounds; ++round) {
    late.delay += best_numbers<1>(late.explained, here.of_a_second, side)[0];
    if (!std::isfinite(late.delay)) break;
    here = of_delay(instants, given.motions, begins, side, late.delay, tuning);
    late.explained.motions = with_added(given.motions, here.added, side);
    late.explained.fit = robust_fit(late.explained.motions, options.fit);
  }
  late.comparison = compare(given, late.explained);
  return late;
}

/// "he positions of b are about 0.30 s later than its rotations": a T or a t comes before it.
std::string claim_of(const LatePositions& found) {
  return format("he positions of %s are about %.2f s %s than its rotations",
                mark(found.side == Side::a ? 'a' : 'b'), std::abs(found.delay),
                found.delay > 0 ? "later" : "earlier");
}

Finding worded_one(const LatePositions& found, const LatePositions* other, const std::string& clock) {
  const char which = found.side == Side::a ? 'a' : 'b';
  Finding finding;
  finding.code = std::string("late_positions_") + which;
  finding.certain = other == nullptr;
  finding.improvement = std::exp(found.comparison.gain);
  finding.T_a_b = to_pose(found.explained.fit.T);
  finding.value = found.delay;
  const std::string open =
      other ? format(", or those of %s are %s by as much", mark(other->side == Side::a ? 'a' : 'b'),
                     other->delay > 0 ? "later" : "earlier")
            : "";
  say(finding, (clock.empty() ? "T" : clock + " t") + claim_of(found),
      format("Give positions and rotations of %s of the same times: no filter that smooths or delays one of "
             "them.",
             mark(which)),
      open + format(": the squared residuals are %.3g times smaller with both at the same times.",
                    finding.improvement));
  return finding;
}

}  // namespace

std::optional<LateOfEither> best_late_positions(const Instants& instants, const Explained& given,
                                                const DiagnosisOptions& options, std::optional<Side> behind,
                                                const LatePositionsOptions& late) {
  if (instants.size() < 3 || given.motions.all.size() < options.motions.least) return std::nullopt;
  const std::vector<std::size_t> begins = begins_of(instants, given.motions);
  std::optional<LatePositions> best, other;
  for (const Side side : {Side::b, Side::a}) {
    LatePositions here = fitted(instants, given, begins, side, options, late);
    if (!std::isfinite(here.delay)) continue;
    (best ? other : best) = std::move(here);
  }
  if (!best) return std::nullopt;
  if (other && other->comparison.gain > best->comparison.gain) std::swap(best, other);
  if (other && better(compare(other->explained, best->explained), options.alike, options)) other.reset();
  const bool other_first = other && (behind ? other->side == *behind : other->delay > 0 && best->delay <= 0);
  return LateOfEither{*std::move(best), std::move(other), other_first};
}

bool certain(const LateOfEither& found, const DiagnosisOptions& options, const LatePositionsOptions& late) {
  return std::abs(found.best.delay) >= late.least && explains(found.best.explained, options) &&
         number_explains(found.best.comparison, options);
}

std::vector<Finding> worded(const LateOfEither& found, const char* clock) {
  const LatePositions* const other = found.other ? &*found.other : nullptr;
  std::vector<Finding> findings{worded_one(found.best, other, clock)};
  if (other)
    findings.insert(found.other_first ? findings.begin() : findings.end(),
                    worded_one(*other, &found.best, clock));
  return findings;
}

}  // namespace egocal::detail
