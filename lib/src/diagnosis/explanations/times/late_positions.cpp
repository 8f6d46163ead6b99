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
#include "diagnosis/motions/stillest_point.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

using Eigen::Vector3d;
using Changes = std::vector<Vector3d>;

/// What a second of delay adds to the translation of each motion, in the frame of its begin [m/s].
struct ByDelay {
  Changes a, b;
  const Changes& of(Side side) const { return side == Side::a ? a : b; }
};

/// Of the positions of a stream about an instant, by those on either side.
class Speeds {
 public:
  Speeds(const Instants& instants, const LatePositionsOptions& late)
      : instants_(instants),
        side_(std::clamp<std::size_t>(
            static_cast<std::size_t>(std::ceil(0.5 * late.least_span / std::max(instants.period, 1e-6))), 1,
            late.most_instants)) {}

  std::pair<Vector3d, Vector3d> at(std::size_t i) const {
    const std::size_t before = i >= side_ ? i - side_ : 0, after = std::min(i + side_, instants_.size() - 1);
    const PosePair from = instants_.at(before), to = instants_.at(after);
    const double seconds = instants_.time(after) - instants_.time(before);
    if (!(seconds > 0)) return {Vector3d::Zero(), Vector3d::Zero()};
    return {(position_of(to.a) - position_of(from.a)) / seconds,
            (position_of(to.b) - position_of(from.b)) / seconds};
  }

 private:
  const Instants& instants_;
  std::size_t side_;
};

ByDelay changes_of(const Instants& instants, const Motions& motions, const LatePositionsOptions& late) {
  const Speeds speeds(instants, late);
  const auto span = static_cast<std::size_t>(motions.stride);
  ByDelay changes;
  for (const std::size_t i : begins_of(instants, motions)) {
    const PosePair begin = instants.at(i);
    const auto [from_a, from_b] = speeds.at(i);
    const auto [to_a, to_b] = speeds.at(i + span);
    changes.a.push_back(rotation_of(begin.a).transpose() * (to_a - from_a));
    changes.b.push_back(rotation_of(begin.b).transpose() * (to_b - from_b));
  }
  return changes;
}

/// The motions with the positions of one stream taken `delay` later.
Motions later(const Motions& given, const Changes& changes, Side side, double delay) {
  Motions motions = given;
  for (std::size_t i = 0; i < motions.all.size(); ++i) {
    Motion& motion = motions.all[i];
    set_motion(motion, side, to_pose(side == Side::a ? motion.a : motion.b).rotation,
               (side == Side::a ? motion.t_a : motion.t_b) + delay * changes[i]);
  }
  return motions;
}

LatePositions fitted(const Explained& given, const Changes& changes, Side side,
                     const DiagnosisOptions& options) {
  LatePositions late{side, 0, given, {}};
  for (int round = 0; round < options.fit.rounds; ++round) {
    late.delay += best_numbers<1>(late.explained, changes, side)[0];
    late.explained.motions = later(given.motions, changes, side, late.delay);
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
  const ByDelay changes = changes_of(instants, given.motions, late);
  std::optional<LatePositions> best, other;
  for (const Side side : {Side::b, Side::a}) {
    LatePositions here = fitted(given, changes.of(side), side, options);
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
