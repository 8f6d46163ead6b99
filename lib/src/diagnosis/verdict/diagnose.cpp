// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnosis/explanations/askew_rotations.hpp"
#include "diagnosis/explanations/clock_check.hpp"
#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/explanations/forward.hpp"
#include "diagnosis/explanations/late_rotations.hpp"
#include "diagnosis/explanations/not_a_move.hpp"
#include "diagnosis/explanations/other_poses.hpp"
#include "diagnosis/explanations/planes.hpp"
#include "diagnosis/explanations/replacing.hpp"
#include "diagnosis/goal/goal.hpp"
#include "diagnosis/motions/fit.hpp"
#include "diagnosis/motions/standing_still.hpp"
#include "diagnosis/mount/back_and_forth.hpp"
#include "diagnosis/mount/following_mount.hpp"
#include "diagnosis/mount/large_move.hpp"
#include "diagnosis/mount/mount.hpp"
#include "diagnosis/mount/swaying_mount.hpp"
#include "diagnosis/streams/contradicting_parts.hpp"
#include "diagnosis/streams/interpolated_stream.hpp"
#include "diagnosis/streams/pace.hpp"
#include "diagnosis/streams/stamps_in_bursts.hpp"
#include "diagnosis/streams/stream_check.hpp"
#include "diagnosis/streams/turning_alike.hpp"
#include "diagnosis/streams/undersampling.hpp"
#include "diagnosis/verdict/judge.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/foresee.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal {

/// What needs no answer.
struct detail::Foreseen {
  const Trajectory &a, &b;
  PairingOptions pairing;
  DiagnosisOptions options;
  Evidence evidence;
  std::vector<Finding> findings{};  ///< about the streams, where there are enough motions
  /// What else explains streams of which one stops at times: an arm holds still, and may be misread besides.
  std::vector<Finding> beside_frozen{};
  bool has_offset = false;
  std::optional<TimeOffset> offset{};  ///< offset_by_turning(), where it was looked for already
};

namespace {

using namespace detail;

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

bool has(const std::vector<Finding>& findings, std::string_view code) {
  return std::any_of(findings.begin(), findings.end(),
                     [code](const Finding& one) { return one.code == code; });
}

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

/// Of one of the streams. That the streams as given fit in some directions is no evidence against it.
bool is_another_reading(const Finding& finding) {
  const std::string_view code = finding.code;
  return code == "inverted_a" || code == "inverted_b" || code.starts_with("quaternion_order_") ||
         code.starts_with("axes_");
}

/// The motions contradict only what they show of an answer. Where another extrinsic suits them better, and
/// differs from it in directions that are not known alone, that one counts.
Misfit where_known(const Misfit& misfit, const Motions& motions, const Answered& answered,
                   const DualQuaternion& best) {
  constexpr double standard_deviations = 3;  // mathematics: 99.7 % of what is known keeps within
  if (!(misfit.best < misfit.at_answer)) return misfit;
  const Vector6d difference = frame_a_difference(answered.T_a_b, best);
  bool all_known = true;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!answered.observability.observable[k])
      all_known = false;
    else if (std::abs(difference[i]) >
             standard_deviations * with_further_parts(answered.observability.stddev[k], answered, k))
      return misfit;
  }
  if (all_known) return misfit;
  return {misfit.best, misfit.best, median_misfit(motions, evaluated(motions, best))};
}

/// What is left where no reading, scale or clock explains the motions. misfit: by what is no noise.
void look_further(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                  const Fit& fit, const DiagnosisOptions& options, Misfit& misfit,
                  std::vector<Finding>& findings) {
  const Motions& motions = evidence.given.explained.motions;
  double turned = 0;
  for (const Motion& motion : motions.all) turned += std::min(motion.angle_a, motion.angle_b);
  turned *= static_cast<double>(evidence.instants.size()) /
            static_cast<double>(motions.all.size() * static_cast<std::size_t>(motions.stride));
  if (turned < options.least_turning) {
    findings.push_back(too_little_motion(motions.all.size(), options));
    // what the rotations leave is noise: the translations alone can contradict the answer
    misfit.at_answer = misfit.median = fit.translation_relative_median;
    return;
  }
  const double correlation = turning_correlation(motions);
  const bool one_drive = travel_together(motions);
  if (one_drive && misfit.best > options.doubtful_misfit &&
      correlation < options.unrelated_part_correlation &&
      fit.translation_relative_median < options.unrelated_misfit) {
    findings.push_back(turning_in_noise(correlation));
    // what the rotations leave is noise: the translations alone can contradict the answer
    misfit.at_answer = misfit.median = fit.translation_relative_median;
    return;
  }
  // rotations that were misread do not turn as the other stream does, either
  if (answered.problem.mode != Mode::planar)
    if (std::optional<Finding> contents = other_contents(evidence, options)) {
      // small angles times a factor are nearly those of rotation vectors: both are named where both fit
      std::vector<Finding> others = wrong_stream(evidence, options);
      const double gain = others.empty() ? 0 : std::log(others.front().improvement / contents->improvement);
      if (gain < -options.alike) others.clear();
      if (gain <= options.alike) others.insert(others.end(), *std::move(contents));
      findings.insert(findings.begin(), others.begin(), others.end());
      return;
    }
  if (misfit.best > options.contradictory_misfit && correlation < options.unrelated_correlation) {
    findings.push_back(unrelated(correlation));
    return;
  }
  for (Finding& finding : unrelated_part(motions)) {
    findings.push_back(std::move(finding));
    return;
  }
  if (answered.seconds >= options.unrelated_least_seconds && misfit.best > options.unrelated_misfit &&
      misfit.best <= options.contradictory_misfit && !one_drive &&
      turning_correlation(motions, options.unrelated_part) < options.unrelated_part_correlation) {
    findings.push_back(unrelated(correlation));
    return;
  }
  std::vector<Finding> wrong;
  if (answered.problem.mode != Mode::planar) wrong = wrong_stream(evidence, options);
  const auto explains_more = [&wrong](double improvement) {
    return wrong.empty() || improvement > wrong.front().improvement;
  };
  MovedMount moved = moved_mount(evidence.instants, answered, options);
  std::vector<Finding>& moves = moved.findings;
  // where a stream is wrong, parts of the drive with other speeds and headings have other extrinsics
  if (!moves.empty() && !wrong.empty() && !explains_more(std::exp(gain_of_parts(evidence, moves, options))))
    moves.clear();
  if (answered.problem.mode != Mode::planar && !has(findings, "axes_both"))
    if (std::optional<Finding> inverse = inverse_rotations_instead(evidence, moves, answered, options))
      findings.push_back(*std::move(inverse));
  moves = moves_or_else(std::move(moves), pairing, evidence, answered, readings_of_both(findings), options);
  // a mount that moved looks like many things, and another reading of both streams like one that moved
  if (!moves.empty()) {
    std::erase_if(findings, [](const Finding& one) { return !one.code.ends_with("_both"); });
    findings.insert(findings.begin(), moves.begin(), moves.end());
    return;
  }
  if (scale_may_change(fit, options))
    if (std::optional<Finding> scale = changing_scale(pairing, evidence, answered, options);
        scale && explains_more(scale->improvement)) {
      findings.insert(findings.begin(), *std::move(scale));
      return;
    }
  if (const std::optional<UnexplainedPart> part = unexplained_part(motions, evidence.given.explained.fit.T)) {
    findings.push_back(unexplained(*part));
    return;
  }
  if (!wrong.empty()) {
    findings.insert(findings.begin(), wrong.begin(), wrong.end());
    return;
  }
  std::optional<Finding> last;
  if (answered.problem.mode != Mode::planar) last = back_and_forth(evidence.instants, answered, options);
  if (!last && answered.problem.mode != Mode::planar)
    last = swaying_mount(evidence.instants, answered, options);
  if (!last && answered.problem.mode != Mode::planar)
    last = following_mount(evidence.instants, evidence.stride, answered, options);
  if (!last)
    last = contradicting_parts_finding(
        contradicting_parts(evidence.instants, evidence.stride, to_pose(answered.T_a_b), options.motions));
  if (!last) last = contradicting_times(moved.unexplained, options);
  if (last) findings.insert(findings.begin(), *std::move(last));
}

/// There is nothing further to look for. Twin readings that both fit far better are uncertain each, but one
/// of them is right.
bool explains(const Finding& finding, const DiagnosisOptions& options) {
  return finding.certain || finding.code == "samples" ||
         (finding.code != "inverted_both" && finding.improvement > options.overwhelming);
}

/// One of the two streams is inverted; which one is open.
bool one_is_inverted(const std::vector<Finding>& findings, const DiagnosisOptions& options) {
  const auto named = [&](std::string_view code) {
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& one) {
      return one.code == code && one.improvement > std::exp(options.gain);
    });
  };
  return named("inverted_a") && named("inverted_b");
}

/// A wrong scale that few motions show, where nothing else is certain.
void name_wrong_scale(const Evidence& evidence, const PairingOptions& pairing,
                      const DiagnosisOptions& options, std::vector<Finding>& findings) {
  for (const Finding& finding : findings)
    if (explains(finding, options) || finding.code == "mount_moved") return;
  std::optional<Finding> scale = wrong_scale(evidence, options);
  if (!scale) scale = wrong_scale_of_drive(evidence, pairing, options);
  if (!scale) return;
  // the same with less certainty, and what its motions were taken for
  std::erase_if(findings, [](const Finding& one) {
    return one.code == "scale" || one.code == "units" || one.code == "inverted_both";
  });
  findings.push_back(*std::move(scale));
}

/// What no part of the drive shows by itself, where nothing else explains the streams.
void name_askew_rotations(const Evidence& evidence, const Answered& answered, const DiagnosisOptions& options,
                          std::vector<Finding>& findings) {
  if (answered.problem.mode == Mode::planar) return;
  for (const Finding& finding : findings)
    if ((finding.certain && !finding.code.starts_with("undersampled_")) || finding.code == "mount_moved" ||
        finding.code == "scale_change" || finding.code == "samples" || finding.code == "odometry")
      return;
  if (std::optional<Finding> askew = askew_rotations(evidence.instants, evidence.stride, answered, options))
    findings.push_back(*std::move(askew));
}

bool of_clock(const Finding& finding) {
  return finding.code.starts_with("clock_");
}

bool of_frozen_stream(const Finding& finding) {
  return finding.code.starts_with("frozen_");
}

/// What clocks that differ and interpolation change. Of streams that are understood otherwise: a wrong answer
/// has no standard deviation that could be right.
void look_at_times(const Foreseen& foreseen, Answered& answered, Diagnosis& result) {
  const Trajectory &a = foreseen.a, &b = foreseen.b;
  const PairingOptions& pairing = foreseen.pairing;
  const DiagnosisOptions& options = foreseen.options;
  if (answered.problem.mode == Mode::planar) return;
  const auto certain = [&](const auto& which) {
    return std::find_if(result.findings.begin(), result.findings.end(),
                        [&](const Finding& one) { return one.certain && which(one); });
  };
  if (certain([](const Finding& one) { return !of_clock(one); }) != result.findings.end()) return;
  const MiddlePart part = middle_part(a, b, options.change.most_poses);
  const Instants instants =
      synchronised(part.a, part.b, {pairing.time_offset, 0, 0}, pairing.max_gap, 1, options.motions);
  const std::array<double, 6> of_interpolation = interpolation_stddev(instants, answered.T_a_b, options);
  auto clock = certain(of_clock);
  if (clock == result.findings.end()) {
    const std::optional<TimeOffset> found =
        foreseen.has_offset ? foreseen.offset : offset_by_turning(part, pairing, options.clock_check);
    if (std::optional<Finding> offset =
            small_clock_offset(a, b, pairing, part, instants, found, answered, options)) {
      // the same with less certainty
      std::erase_if(result.findings, of_clock);
      clock = result.findings.insert(result.findings.begin(), *std::move(offset));
    }
  }
  Vector6d moved = Vector6d::Zero();
  if (clock != result.findings.end() && clock->T_a_b)
    moved = frame_a_difference(answered.T_a_b, to_dual_quaternion(*clock->T_a_b));
  for (std::size_t i = 0; i < 6; ++i)
    answered.timing_stddev[i] = std::hypot(of_interpolation[i], moved[static_cast<Eigen::Index>(i)]);
  result.timing_stddev = answered.timing_stddev;
  if (std::optional<Finding> finding =
          undersampled(instants, answered, of_interpolation, options.undersampling))
    result.findings.push_back(*std::move(finding));
}

Foreseen foresee(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                 const DiagnosisOptions& options) {
  Foreseen foreseen{a, b, pairing, options,
                    gather(a, b, {pairing.time_offset, 0, 0}, pairing.max_gap, options)};
  if (foreseen.evidence.given.explained.motions.all.size() < options.motions.least) return foreseen;
  foreseen.findings = check_streams(a, b, foreseen.evidence.instants);
  if (pairing.mode == Mode::planar)  // level positions are what planar mode is for
    std::erase_if(foreseen.findings, [](const Finding& one) { return one.code.starts_with("flat_"); });
  const bool still = standing_still(foreseen.evidence.instants);
  if (still)  // a pose that never changes is that of an odometry without noise
    std::erase_if(foreseen.findings, [](const Finding& one) {
      return one.code.starts_with("missing_") || one.code.starts_with("flat_") || of_frozen_stream(one);
    });
  if (foreseen.findings.empty() && still)
    foreseen.findings = {too_little_motion(foreseen.evidence.given.explained.motions.all.size(), options)};
  // what is wrong with the streams themselves looks like other mistakes
  if (foreseen.findings.empty())
    foreseen.findings = explain(foreseen.evidence, options);
  else if (std::all_of(foreseen.findings.begin(), foreseen.findings.end(), of_frozen_stream))
    foreseen.beside_frozen = explain(foreseen.evidence, options);
  // of a million poses 8 MB that only explain() looks at
  foreseen.evidence.streams.turning_a = foreseen.evidence.streams.turning_b = {};
  foreseen.evidence.turning_a = foreseen.evidence.turning_b = std::vector<float>();
  return foreseen;
}

/// With a tolerance of the translation that suits the unit of the lengths.
DiagnosisOptions in_unit_of(const Motions& motions, DiagnosisOptions options) {
  if (options.unit != LengthUnit::unknown || !(motions.rotation > 0)) return options;
  options.tolerance_translation = options.tolerance_rotation * motions.translation / motions.rotation;
  return options;
}

Diagnosis diagnosed(const Foreseen& foreseen, const Answered& given) {
  const PairingOptions& pairing = foreseen.pairing;
  const Evidence& evidence = foreseen.evidence;
  const Motions& motions = evidence.given.explained.motions;
  const DiagnosisOptions options = in_unit_of(motions, foreseen.options);
  Answered answered = given;
  if (!evidence.instants.empty())
    answered.seconds = evidence.instants.time(evidence.instants.size() - 1) - evidence.instants.time(0);
  answered.platform = forward(heading(motions), options.heading) ? Platform::car : Platform::handheld;
  if (motions.all.size() < options.motions.least) {
    Diagnosis result = diagnose(answered, options);
    result.fit =
        fit_at(motions, to_pose(answered.T_a_b), evidence.stride * evidence.instants.period, options.motions);
    result.findings.push_back(too_little_motion(motions.all.size(), options));
    judge(result, answered, {}, options);
    return result;
  }
  Diagnosis result;
  result.fit =
      fit_at(motions, to_pose(answered.T_a_b), evidence.stride * evidence.instants.period, options.motions);
  result.findings = foreseen.findings;
  if (answered.problem.mode == Mode::planar)
    for (Finding& finding :
         check_planes(motions, answered.problem.plane_a, answered.problem.plane_b, options.planes))
      result.findings.push_back(std::move(finding));
  // while the sensors stand, noise would be compared with noise
  const Motions moving = without_rest(motions, to_pose(answered.T_a_b));
  const RobustFit at_answer = evaluated(moving, answered.T_a_b);
  const DualQuaternion& best = evidence.given.explained.fit.T;
  Misfit misfit{detail::misfit(moving, at_answer), detail::misfit(moving, evaluated(moving, best)),
                median_misfit(moving, at_answer)};
  // pairing rejects the motions of a frozen stream: what contradicts the answer is something else
  const bool more_than_frozen = misfit.at_answer > options.doubtful_misfit;
  if (more_than_frozen)
    result.findings.insert(result.findings.begin(), foreseen.beside_frozen.begin(),
                           foreseen.beside_frozen.end());
  const auto is_explanation = [&](const Finding& one) {
    return explains(one, options) && !(more_than_frozen && of_frozen_stream(one));
  };
  const bool explained = replace_by_large_move(pairing, evidence, answered, options, result.findings) ||
                         replace_by_moves(pairing, evidence, answered, options, result.findings) ||
                         replace_by_wrong_stream(evidence, answered, options, result.findings) ||
                         one_is_inverted(result.findings, options) ||
                         std::any_of(result.findings.begin(), result.findings.end(), is_explanation);
  if (has(result.findings, "too_little_motion")) misfit = {};  // noise contradicts every answer
  if (!explained) look_further(pairing, evidence, answered, result.fit, options, misfit, result.findings);
  name_wrong_scale(evidence, pairing, options, result.findings);
  StreamCheckOptions checks;
  if (options.unit == LengthUnit::unknown) {
    const double of_a_metre = options.tolerance_translation / DiagnosisOptions().tolerance_translation;
    checks.close *= of_a_metre;
    checks.known_translation *= of_a_metre;
  }
  if (std::none_of(result.findings.begin(), result.findings.end(),
                   [](const Finding& one) { return one.certain; }))
    // that one stream was made from the other explains an answer that is the identity, too
    for (const std::vector<Finding>& found :
         {made_from_each_other(result.fit), in_one_frame(answered, checks)})
      if (!has(result.findings, "same_stream"))
        result.findings.insert(result.findings.end(), found.begin(), found.end());
  const auto reads_otherwise = [](const Finding& one) {
    return one.certain && one.code.starts_with("inverted_");
  };
  if (std::any_of(result.findings.begin(), result.findings.end(), reads_otherwise)) {
    // the pace is that of inverse poses
  } else if (std::optional<Finding> pace =
                 impossible_pace(motions, evidence.stride * evidence.instants.period,
                                 evidence.instants.period, options.unit == LengthUnit::metres, options.pace))
    result.findings.insert(result.findings.begin(), *std::move(pace));
  look_at_times(foreseen, answered, result);
  if (pairing.mode != Mode::planar) name_late_rotations(evidence, pairing.max_gap, options, result.findings);
  name_askew_rotations(evidence, answered, options, result.findings);
  for (Finding& finding : interpolated_streams(foreseen.a, foreseen.b))
    if (!has(result.findings, finding.code)) result.findings.push_back(std::move(finding));
  // what else was found may be of the stamps alone
  const std::vector<Finding> bursts = stamps_in_bursts(foreseen.a, foreseen.b, result.fit);
  result.findings.insert(result.findings.begin(), bursts.begin(), bursts.end());
  if (std::none_of(result.findings.begin(), result.findings.end(), is_another_reading))
    misfit = where_known(misfit, moving, answered, best);
  judge(result, answered, misfit, options);
  return result;
}

}  // namespace

Diagnosis diagnose(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                   const Answered& answered, const DiagnosisOptions& options) {
  return diagnosed(foresee(a, b, pairing, options), answered);
}

Foresight::Foresight(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                     const DiagnosisOptions& options)
    : foreseen_(std::make_unique<Foreseen>(foresee(a, b, pairing, options))) {
  const std::vector<Finding>& found = foreseen_->findings;
  if (pairing.mode == Mode::planar ||
      std::any_of(found.begin(), found.end(), [](const Finding& one) { return one.certain; }))
    return;
  foreseen_->offset =
      offset_by_turning(middle_part(a, b, options.change.most_poses), pairing, options.clock_check);
  foreseen_->has_offset = true;
}
Foresight::~Foresight() = default;

Diagnosis Foresight::diagnose(const Answered& answered) const {
  return diagnosed(*foreseen_, answered);
}

Diagnosis diagnose(std::span<const MotionPair> pairs, const Answered& answered,
                   const DiagnosisOptions& given) {
  const Motions motions = motions_of(pairs, given.motions);
  const DiagnosisOptions options = in_unit_of(motions, given);
  Diagnosis result;
  result.fit = fit_at(motions, to_pose(answered.T_a_b), 0, options.motions);
  Misfit misfit;
  if (motions.all.size() >= options.motions.least) {
    misfit.at_answer = misfit.best = detail::misfit(motions, evaluated(motions, answered.T_a_b));
  } else {
    result.findings.push_back(too_little_motion(motions.all.size(), options));
  }
  judge(result, answered, misfit, options);
  return result;
}

Diagnosis diagnose(const Answered& answered, const DiagnosisOptions& options) {
  Diagnosis result;
  judge(result, answered, {}, options);
  return result;
}

}  // namespace egocal
