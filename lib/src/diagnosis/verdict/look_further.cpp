// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/look_further.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/contents/inverted_and_moved.hpp"
#include "diagnosis/explanations/lengths/not_a_move.hpp"
#include "diagnosis/explanations/lengths/part_of_other_scale.hpp"
#include "diagnosis/motions/fit.hpp"
#include "diagnosis/mount/back_and_forth.hpp"
#include "diagnosis/mount/following_mount.hpp"
#include "diagnosis/mount/large_move.hpp"
#include "diagnosis/mount/mount.hpp"
#include "diagnosis/mount/swaying_mount.hpp"
#include "diagnosis/streams/contradicting_parts.hpp"
#include "diagnosis/streams/filled_gaps.hpp"
#include "diagnosis/streams/one_drive.hpp"
#include "diagnosis/streams/turning_alike.hpp"
#include "diagnosis/streams/wrong_poses.hpp"
#include "diagnosis/verdict/turning_noise.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

Finding unexplained(const UnexplainedPart& part) {
  Finding finding = certain_finding(
      "unrelated",
      format(
          "The answer explains the motions of the drive but for those from %.0f to %.0f s after the start, "
          "which contradict it: a sensor was moved, a clock jumped, or an odometry was lost.",
          part.begin, part.end),
      "Use the part of the drive where the streams belong together.");
  finding.time = part.begin;
  return finding;
}

struct ContradictingTenthsOptions {
  std::size_t least = 100;  ///< motions of the drive: ten of each tenth
  double of_way = 0.5;      ///< median residual of a tenth, as a part of the way
  double times = 3;         ///< and in metres, as a multiple of the median tenth
  /// And as a part of the tolerance of an answer: 3 cm. Sensors that stand but shake left up to 1.3 cm in 163
  /// clean drives, which is any part of their way.
  double of_tolerance = 0.05;
};

/// Where the scale of less than half of the drive is another one, its tenths show it. While the sensors stand
/// any residual is a large part of the way, but a small one in metres.
bool scale_may_change(const Fit& fit, const DiagnosisOptions& options) {
  const double usual = fit.translation_relative_median;
  return usual > options.scale_change_misfit ||
         std::any_of(fit.tenths.begin(), fit.tenths.end(), [&](const FitTenth& tenth) {
           return tenth.translation_median > fit.translation_median &&
                  tenth.translation_relative >
                      std::max(options.scale_change_misfit, options.scale_change_in_tenth * usual);
         });
}

/// Tenths whose translations contradict the answer, one after the other, while those of most do not. Where
/// the sensors stand, any residual is a large part of the way, but no larger in metres.
std::optional<UnexplainedPart> contradicting_tenths(const Fit& fit, std::size_t motions, double tolerance) {
  const ContradictingTenthsOptions options;
  if (motions < options.least || fit.tenths.empty()) return std::nullopt;
  std::vector<double> lengths;
  for (const FitTenth& tenth : fit.tenths)
    if (tenth.translation_median > 0) lengths.push_back(tenth.translation_median);
  const double least = std::max(options.times * median(std::move(lengths)), options.of_tolerance * tolerance);
  const auto contradicts = [&](const FitTenth& tenth) {
    return tenth.translation_relative > options.of_way && tenth.translation_median > least;
  };
  const auto first = std::find_if(fit.tenths.begin(), fit.tenths.end(), contradicts);
  if (first == fit.tenths.end()) return std::nullopt;
  const auto last = std::find_if_not(first, fit.tenths.end(), contradicts);
  return UnexplainedPart{first->begin, std::prev(last)->end};
}

/// What is wrong with a part of the drive that contradicts the answer of the rest. kept: without wrong poses,
/// which may spoil most motions of a tenth.
std::optional<Finding> of_a_part(const Evidence& evidence, const Instants& kept, const Answered& answered,
                                 bool tenths_too, const DiagnosisOptions& options) {
  const Explained& given = evidence.given.explained;
  std::optional<Motions> of_kept;
  if (kept.size() < evidence.instants.size())
    of_kept = motions_of(kept, {}, {}, evidence.stride, options.motions.most, options.motions);
  const Motions& motions = of_kept ? *of_kept : given.motions;
  std::optional<UnexplainedPart> part = unexplained_part(motions, given.fit.T);
  if (!part && tenths_too)
    part = contradicting_tenths(fit_at(motions, to_pose(answered.T_a_b), 0, options.motions),
                                motions.all.size(), options.tolerance_translation);
  if (!part || spoiled_by_wrong_poses(motions, to_pose(given.fit.T), part->begin, part->end))
    return std::nullopt;
  if (std::optional<Finding> scale = part_of_other_scale(given, part->begin, part->end, options))
    return scale;
  return unexplained(*part);
}

/// What the motions leave is the noise of their steps, and the translations agree.
bool left_by_noise(const Evidence& evidence, const Fit& fit, const DiagnosisOptions& options,
                   const Misfit& misfit) {
  const TurningNoiseOptions noise;
  const Explained& given = evidence.given.explained;
  return misfit.median > options.unrelated_misfit && fit.translation_relative_median < noise.most_of_way &&
         steps_leave_noise(evidence.instants, given.motions, to_pose(given.fit.T), noise);
}

/// Words inverted_both beside a possible move: a mounting that moved once looks as if both streams were
/// inverted, and then has an answer that fits.
void word_beside_moves(Finding& finding) {
  if (finding.code != "inverted_both" || finding.certain) return;
  say(finding, "If the poses of both streams are world-to-sensor",
      "Find out how the poses were made. {solve}--invert-a --invert-b is right for world-to-sensor poses "
      "alone: "
      "for others it gives a wrong answer that fits.",
      ", the mounting did not change and the answer is another one; the motions cannot tell.");
}

/// The angle that both streams turn by in the drive, as far as the motions show it [rad].
double turned_together(const Evidence& evidence) {
  const Motions& motions = evidence.given.explained.motions;
  double turned = 0;
  for (const Motion& motion : motions.all) turned += std::min(motion.angle_a, motion.angle_b);
  return turned * (static_cast<double>(evidence.instants.size()) /
                   static_cast<double>(motions.all.size() * static_cast<std::size_t>(motions.stride)));
}

/// Why the streams do not turn together, or not enough; empty: they do.
std::optional<Finding> turning_apart(const Evidence& evidence, const Answered& answered, const Fit& fit,
                                     const DiagnosisOptions& options, Misfit& misfit) {
  const Motions& motions = evidence.given.explained.motions;
  // what the rotations leave is noise: the translations alone can contradict the answer
  const auto take_translations_alone = [&] {
    misfit.at_answer = misfit.median = relative_by_way(motions, to_pose(answered.T_a_b));
  };
  if (turned_together(evidence) < options.least_turning) {
    take_translations_alone();
    return too_little_motion(motions.all.size(), options);
  }
  const double correlation = turning_correlation(motions);
  const bool noise = left_by_noise(evidence, fit, options, misfit);
  const bool one_drive = noise || travel_together(motions);
  const double way = noise ? TurningNoiseOptions().most_of_way : options.unrelated_misfit;
  if (one_drive && misfit.best > options.doubtful_misfit &&
      correlation < options.unrelated_part_correlation && fit.translation_relative_median < way) {
    take_translations_alone();
    return turning_in_noise(correlation);
  }
  if (noise) take_translations_alone();
  if (!noise && misfit.best > options.contradictory_misfit && correlation < options.unrelated_correlation)
    return unrelated(correlation);
  if (std::vector<Finding> part = unrelated_part(motions); !part.empty()) return std::move(part.front());
  if (answered.seconds >= options.unrelated_least_seconds && misfit.best > options.unrelated_misfit &&
      misfit.best <= options.contradictory_misfit && !one_drive &&
      turning_correlation(motions, options.unrelated_part) < options.unrelated_part_correlation)
    return unrelated(correlation);
  return {};
}

/// Finding of the last checks, where nothing else is found.
std::optional<Finding> last_of_all(const Instants& instants, int stride, const Answered& answered,
                                   const MovedMount& moved, const DiagnosisOptions& options) {
  std::optional<Finding> last;
  if (answered.problem.mode != Mode::planar) {
    last = back_and_forth(instants, answered, options);
    if (!last) last = swaying_mount(instants, answered, options);
    if (!last) last = following_mount(instants, stride, answered, options);
  }
  if (!last)
    last = contradicting_parts_finding(
        contradicting_parts(instants, stride, to_pose(answered.T_a_b), options.motions));
  return last ? last : contradicting_times(moved.unexplained, options);
}

}  // namespace

void look_further(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                  const Fit& fit, const DiagnosisOptions& options, WrongStream& wrong_stream, Misfit& misfit,
                  std::vector<Finding>& findings) {
  // rotations that were misread do not turn as the other stream does, or hardly at all
  if (!explains(evidence.scaled.explained, options) && !wrong_stream.contents().empty()) {
    const std::vector<Finding>& wrong = wrong_stream.best();
    findings.insert(findings.begin(), wrong.begin(), wrong.end());
    return;
  }
  const bool planar = answered.problem.mode == Mode::planar;
  if (!planar)
    if (std::optional<Finding> filled = filled_gaps(evidence, answered.T_a_b)) {
      findings.insert(findings.begin(), *std::move(filled));
      return;
    }
  if (std::optional<Finding> apart = turning_apart(evidence, answered, fit, options, misfit)) {
    findings.push_back(*std::move(apart));
    return;
  }
  const std::vector<Finding>& wrong = wrong_stream.best();
  const auto explains_more = [&wrong](double improvement) {
    return wrong.empty() || improvement > wrong.front().improvement;
  };
  const Instants kept = without_wrong_poses(evidence.instants, to_pose(answered.T_a_b));
  MovedMount moved = moved_mount(kept, answered, options);
  std::vector<Finding>& moves = moved.findings;
  // where a stream is wrong, parts of the drive with other speeds and headings have other extrinsics
  if (!moves.empty() && !wrong.empty() && !explains_more(std::exp(gain_of_parts(evidence, moves, options))))
    moves.clear();
  const bool of_both = std::any_of(findings.begin(), findings.end(),
                                   [](const Finding& one) { return one.code == "axes_both"; });
  if (!planar && !of_both)
    if (std::optional<Finding> inverse = inverse_rotations_instead(evidence, moves, answered, options))
      findings.push_back(*std::move(inverse));
  moves = moves_or_else(std::move(moves), pairing, evidence, answered, readings_of_both(findings), options);
  // a mount that moved looks like many things, and another reading of both streams like one that moved
  if (!moves.empty()) {
    std::erase_if(findings, [](const Finding& one) { return !one.code.ends_with("_both"); });
    std::for_each(findings.begin(), findings.end(), word_beside_moves);
    findings.insert(findings.begin(), moves.begin(), moves.end());
    // a slight move says little; beside it a large one may be hidden by streams that are both inverted
    const auto slight = [](const Finding& one) { return one.code != "mount_moved" || !one.certain; };
    if (!planar && std::all_of(findings.begin(), findings.end(), slight) &&
        std::none_of(findings.begin(), findings.end(),
                     [](const Finding& one) { return one.code == "inverted_both"; }))
      if (std::optional<Finding> other = inverted_and_moved(evidence, answered, options))
        findings.push_back(*std::move(other));
    return;
  }
  if (!planar)
    if (std::optional<Finding> other = inverted_and_moved(evidence, answered, options)) {
      std::erase_if(findings, [](const Finding& one) { return one.code == "inverted_both"; });
      findings.push_back(*std::move(other));
    }
  if (scale_may_change(fit, options))
    if (std::optional<Finding> scale = changing_scale(pairing, evidence, answered, options);
        scale && explains_more(scale->improvement)) {
      findings.insert(findings.begin(), *std::move(scale));
      return;
    }
  if (std::optional<Finding> part = of_a_part(evidence, kept, answered, wrong.empty(), options)) {
    findings.push_back(*std::move(part));
    return;
  }
  if (!wrong.empty()) {
    findings.insert(findings.begin(), wrong.begin(), wrong.end());
    return;
  }
  if (std::optional<Finding> last = last_of_all(kept, evidence.stride, answered, moved, options))
    findings.insert(findings.begin(), *std::move(last));
}

}  // namespace egocal::detail
