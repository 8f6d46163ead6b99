// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/both_streams.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/contents/forward.hpp"
#include "diagnosis/streams/pace.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

/// Far from their origin inverse poses travel faster than anything does.
bool too_fast_unless_inverted(const Evidence& evidence, const Explanation& both,
                              const DiagnosisOptions& options) {
  const double period = evidence.instants.period;
  const auto impossible = [&](const Motions& motions) {
    const std::optional<Finding> pace = impossible_pace(motions, evidence.stride * period, period,
                                                        options.unit == LengthUnit::metres, options.pace);
    return pace && pace->certain;
  };
  return impossible(evidence.given.explained.motions) && !impossible(both.explained.motions);
}

/// Number of jumps, either of the odometry under this reading or of the mounting under the given one. A jump
/// is a run of single steps that fit far worse than the others.
std::size_t jumps(const Evidence& evidence, const Explanation& both, const DiagnosisOptions& options) {
  // all of them: one that is not looked at may be the jump
  const Motions steps =
      motions_of(evidence.instants, both.read_a, both.read_b, 1, evidence.instants.size(), options.motions);
  const RobustFit fit = evaluated(steps, both.explained.fit.T);
  if (fit.squares.empty()) return 0;
  const double largest = *std::max_element(fit.squares.begin(), fit.squares.end());
  const double least = std::max(options.jump * options.jump * fit.typical,
                                options.part_of_largest_jump * options.part_of_largest_jump * largest);
  std::size_t count = 0;
  for (std::size_t i = 0; i < fit.squares.size(); ++i)
    if (fit.squares[i] > least && (i == 0 || !(fit.squares[i - 1] > least))) ++count;
  return count;
}

/// An odometry that jumps turns its frame against that of the other one. Motions of the bodies have one
/// extrinsic all the same; under the wrong reading it is that of the two frames, which is another one after
/// each jump. A mounting that moves does the same the other way round, but not as often. Both in parts of the
/// motions and in metres, for either alone may say so of right streams: parts where noise does not grow with
/// the distance, metres where a camera watches a target.
bool one_mounting_only_if_inverted(const Evidence& evidence, const Explanation& both,
                                   const Comparison& comparison, const DiagnosisOptions& options) {
  return explains(both.explained, options) && better(comparison, decisive_loss, options) &&
         loss_in_metres(evidence.given.explained, both.explained) < -decisive_loss &&
         jumps(evidence, both, options) >= options.certain_jumps;
}

}  // namespace

std::optional<Finding> both_inverted(const Evidence& evidence, const DiagnosisOptions& options) {
  PoseReading inverted;
  inverted.invert = true;
  const Explanation both = explained(evidence, "inverted_both", inverted, inverted, options);
  if (both.explained.motions.all.empty()) return std::nullopt;
  const Comparison comparison = compare(evidence.given.explained, both.explained);
  const Heading as_given = heading(evidence.given.explained.motions);
  const Heading as_inverted = heading(both.explained.motions);
  const bool noise_says_given = comparison.ratio < 1 / options.decisive && comparison.gain < -decisive_loss;
  if (forward(as_given, options.heading) && !forward(as_inverted, options.heading)) return std::nullopt;
  // a body that tumbles has no direction of travel, but may seem to under the wrong reading: far from the
  // origin its inverse goes along an arc
  const bool trace = (forward(as_inverted, options.heading) && scattered(as_given, options.heading) &&
                      longer_way(evidence.given.explained.motions, both.explained.motions)) ||
                     too_fast_unless_inverted(evidence, both, options);
  // whatever errs by its rotations errs by metres under the wrong reading, far from the origin
  const bool metres_say_given = explains(both.explained, options) &&
                                loss_in_metres(evidence.given.explained, both.explained) > decisive_loss;
  const bool line_says_given =
      along_one_line(as_given, options.heading) && !along_one_line(as_inverted, options.heading);
  const bool noise_says_inverted = one_mounting_only_if_inverted(evidence, both, comparison, options);
  if (!trace && !noise_says_inverted && (noise_says_given || metres_say_given || line_says_given))
    return std::nullopt;
  Finding finding = finding_of(both, comparison, trace || noise_says_inverted);
  if (!noise_says_inverted) finding.improvement = comparison.ratio;
  return finding;
}

std::optional<Finding> inverted_in_vain(const Evidence& evidence, const DiagnosisOptions& options,
                                        const InvertedInVainOptions& tuning) {
  PoseReading inverted;
  inverted.invert = true;
  const Explanation back = explained(evidence, "inverted_both", inverted, inverted, options);
  const Motions &here = evidence.given.explained.motions, &there = back.explained.motions;
  if (there.all.empty() || !longer_way(here, there)) return std::nullopt;
  const Heading of_here = heading(here), of_there = heading(there);
  if (forward(of_here, options.heading) && !forward(of_there, options.heading)) return std::nullopt;
  if (loss_in_metres(evidence.given.explained, back.explained) > tuning.most_loss) return std::nullopt;
  const Pose T_here = to_pose(evidence.given.explained.fit.T), T_there = to_pose(back.explained.fit.T);
  const double arm_here = T_here.translation.norm(), arm_there = T_there.translation.norm();
  const bool one_world =
      arm_there < tuning.one_world && rotation_log(T_there.rotation).norm() < tuning.one_world_turned;
  if (one_world || !(arm_here > arm_there + options.tolerance_translation)) return std::nullopt;
  const double times = std::sqrt(of_here.way_a * of_here.way_b / (of_there.way_a * of_there.way_b));
  if (!(times > tuning.least_times)) return std::nullopt;
  Finding finding = finding_of(back, compare(evidence.given.explained, back.explained), false);
  finding = worded_reading(std::move(finding), inverted, inverted);
  finding.value = times;
  say(finding, finding.words.claim, finding.words.cure,
      format(", the answer is another one: inverted, both sensors travel %.2g times as far, and hardly agree "
             "better in metres.",
             times));
  return finding;
}

void drop_unlikely_inversion(const Evidence& evidence, const DiagnosisOptions& options,
                             std::vector<Finding>& findings) {
  const auto unlikely = [](const Finding& one) { return one.code == "inverted_both" && !one.certain; };
  const auto of_one_stream = [](const Finding& one) {
    return certain_of_either(one) &&
           (one.code.starts_with("late_positions_") || one.code == "axes_a" || one.code == "axes_b");
  };
  if (std::none_of(findings.begin(), findings.end(), unlikely) ||
      std::none_of(findings.begin(), findings.end(), of_one_stream))
    return;
  PoseReading inverted;
  inverted.invert = true;
  if (longer_way(motions_of(evidence.instants, inverted, inverted, evidence.stride, options.motions.most,
                            options.motions),
                 evidence.given.explained.motions))
    std::erase_if(findings, unlikely);
}

std::optional<Finding> both_orders(const Evidence& evidence, const DiagnosisOptions& options) {
  const int brief = std::max(1, evidence.stride / 16);
  if (brief == evidence.stride) return std::nullopt;
  Explanation given = explained(evidence, brief, "", {}, {}, options);
  // wrong poses that no longer motions contain can spoil the fit of short ones
  const RobustFit of_longer = evaluated(given.explained.motions, evidence.given.explained.fit.T);
  if (of_longer.typical < given.explained.fit.typical) given.explained.fit = of_longer;
  std::optional<Finding> best;
  for (const Candidate& candidate : common_mistakes()) {
    if (std::string_view(candidate.code) != "quaternion_order_both") continue;
    const Explanation here = explained(evidence, brief, candidate.code, candidate.a, candidate.b, options);
    if (given.explained.motions.all.empty() || here.explained.motions.all.empty()) continue;
    if (!explains(here.explained, options)) continue;
    const Comparison comparison = compare(given.explained, here.explained);
    if (!better(comparison, 0, options) || (best && best->improvement > std::exp(comparison.gain))) continue;
    best = worded_reading(finding_of(here, comparison, false), candidate.a, candidate.b);
  }
  return best;
}

}  // namespace egocal::detail
