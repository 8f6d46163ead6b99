// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/explanations/times/late_positions.hpp"
#include "diagnosis/goal/goal.hpp"
#include "diagnosis/streams/turning_alike.hpp"
#include "diagnosis/verdict/far_off.hpp"
#include "diagnosis/verdict/nominal.hpp"
#include "diagnosis/verdict/stability.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"
#include "egocal/directions.hpp"
#include "statistics/distributions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal {

namespace detail {

namespace {

/// 95 % of a normal distribution, on one side (mathematics).
constexpr double confidence_one_sided = 1.645;
/// 95 % of the length of three equal, independent components (mathematics).
constexpr double length_of_three = 2.79;
/// Two answers within this part of the tolerances are near each other: which of them is right matters little.
constexpr double near = 0.5;

/// Largest difference of the finding's answer from this one, in standard deviations that this one states;
/// infinite without an answer.
double in_stated_stddevs(const Finding& finding, const Answered& answered) {
  if (!finding.T_a_b) return INFINITY;
  const Vector6d difference = frame_a_difference(answered.T_a_b, to_dual_quaternion(*finding.T_a_b));
  double largest = 0;
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!answered.observability.observable[k]) continue;
    const double stddev = with_further_parts(answered.observability.stddev[k], answered, k);
    if (difference[i] != 0) largest = std::max(largest, std::abs(difference[i]) / stddev);
  }
  return largest;
}

/// A wrong scale that moves the answer by more than it states to be uncertain.
bool significant_scale(const Finding& finding, const Answered& answered, const ScaleCheckOptions& options) {
  if (!finding.certain || finding.code != "scale" || !finding.T_a_b || !finding.value) return false;
  const double size = std::abs(std::log(*finding.value));
  if (!(size >= options.least)) return false;
  const double significant = size >= options.clear ? options.significant_where_clear : options.significant;
  return in_stated_stddevs(finding, answered) > significant;
}

/// Length that a vector keeps below in 95 % of all cases where its components scatter independently with
/// these standard deviations: a chi-square of as many degrees of freedom as the variances are equal, by
/// Wilson and Hilferty. 1.94 of one component, 2.79 of three equal ones.
double length_95(const std::array<double, 3>& stddev) {
  double sum = 0, sum_of_squares = 0;
  for (const double s : stddev) {
    sum += s * s;
    sum_of_squares += s * s * s * s;
  }
  if (!(sum_of_squares > 0)) return 0;
  const double part = 2 * sum_of_squares / (9 * sum * sum);
  return std::sqrt(sum * std::pow(1 - part + confidence_one_sided * std::sqrt(part), 3));
}

/// What the answer as a whole keeps within, with a chance of 95 %.
struct Known {
  double rotation = 0, translation = 0;  ///< [rad, m]; infinite: some direction is not observable
  /// Directions that must be known better before it keeps within the tolerance: the worst ones, until the
  /// rest would.
  std::string unknown{};
};

/// unstable: of spread_without_fifths().
Known known_to(const Answered& answered, const std::array<double, 6>& unstable,
               const DiagnosisOptions& options) {
  Known result;
  std::array<bool, 6> unknown{};
  for (const std::size_t first : {std::size_t{0}, std::size_t{3}}) {
    const double tolerance = first == 0 ? options.tolerance_translation : options.tolerance_rotation;
    std::array<double, 3> stddev{};
    for (std::size_t i = 0; i < 3; ++i)
      if (expected(answered, first + i))
        stddev[i] =
            answered.observability.observable[first + i]
                ? with_further_parts(std::max(answered.observability.stddev[first + i], unstable[first + i]),
                                     answered, first + i)
                : INFINITY;
    const bool finite = std::all_of(stddev.begin(), stddev.end(), [](double s) { return std::isfinite(s); });
    (first == 0 ? result.translation : result.rotation) = finite ? length_95(stddev) : INFINITY;
    for (std::size_t known = 3; known > 0; --known) {
      const auto worst = std::max_element(stddev.begin(), stddev.end());
      if (std::isfinite(*worst) && length_95(stddev) <= tolerance) break;
      if (*worst == 0) break;
      unknown[first + static_cast<std::size_t>(worst - stddev.begin())] = true;
      *worst = 0;
    }
  }
  for (std::size_t i = 0; i < 6; ++i)
    if (unknown[i]) result.unknown += (result.unknown.empty() ? "" : ", ") + std::string(direction_names[i]);
  return result;
}

/// The answer without some fifth of the drive is another one, far beyond what a direction states: it hinges
/// on a single curve, or motions of different times contradict each other. What is printed is not better
/// known than that.
void add_spread_of_unstable(const std::array<double, 6>& unstable, const Answered& answered,
                            const DiagnosisOptions& options, Diagnosis& diagnosis) {
  const UnstableOptions least;
  for (std::size_t i = 0; i < 6; ++i) {
    const double tolerance = i < 3 ? options.tolerance_translation : options.tolerance_rotation;
    if (!answered.observability.observable[i] || !(unstable[i] > tolerance) ||
        !(unstable[i] > least.times * with_further_parts(answered.observability.stddev[i], answered, i)))
      continue;
    diagnosis.timing_stddev[i] = std::hypot(diagnosis.timing_stddev[i], unstable[i]);
  }
}

/// "Not known to 1 deg and 60 cm yet": the limits are of all directions together, so the standard deviations
/// that are printed may all be smaller.
std::string not_known_yet(const Known& known, const DiagnosisOptions& options) {
  const bool metres = options.unit == LengthUnit::metres;
  std::string together;
  if (std::isfinite(known.rotation)) together += format("%.3g deg", known.rotation * degrees_per_radian);
  if (std::isfinite(known.translation))
    together += (together.empty() ? "" : ", ") + length_in_words(known.translation, metres);
  if (!together.empty()) together = " (all directions together, 95 %: " + together + ")";
  return format("Not known to %.3g deg and %s yet", options.tolerance_rotation * degrees_per_radian,
                length_in_words(options.tolerance_translation, metres).c_str()) +
         together + ": " + known.unknown + ".";
}

/// Whether a finding is of what is wrong with the poses themselves, not of another reading. Pairing rejects
/// poses that repeat.
bool stream_fault(const Finding& finding) {
  return finding.code == "frozen_a" || finding.code == "frozen_b" || finding.code == "flat_a" ||
         finding.code == "flat_b" || finding.code.starts_with("stamps_") ||
         finding.code.starts_with("filled_") ||
         ((finding.code == "same_stream" || finding.code == "time_unit") && finding.certain);
}

/// Whether a finding is of right streams that leave the answer less certain than its motions say.
bool undersampling(const Finding& finding) {
  return finding.code.starts_with("undersampled_");
}

/// Streams that cannot show all directions, whatever is driven.
bool shows_too_little(const Finding& finding) {
  return finding.code == "flat_both" || finding.code == "missing_both";
}

/// A direction that is taken from it is not known; the motions are as good as without it.
bool wrong_nominal(const Finding& finding) {
  return finding.code == "nominal";
}

/// Rotations that drift are wrong a little more each second: the answer hardly is while the drive turns both
/// ways, however well the motions fit without that.
bool drifts(const Finding& finding) {
  return finding.code.starts_with("turning_drift_");
}

/// The streams mean something else than was taken: whatever the answer is, it is not theirs.
bool misread(const Finding& finding) {
  return finding.certain && !wrong_nominal(finding) && finding.code != "scale" &&
         finding.code != "clock_offset" && finding.code != "clock_drift" && finding.code != "clock_step" &&
         finding.code != "mount_moved" && finding.code != "scale_change" &&
         !finding.code.starts_with("late_positions_") && !finding.code.starts_with("held_") &&
         !drifts(finding) && !stream_fault(finding) && !undersampling(finding) && !shows_too_little(finding);
}

/// A clock that is off by little, which noise alone may show: half a minute on rails knows x to metres, and
/// fits better with 17 ms. It contradicts the answer only beyond what that states to be uncertain.
bool within_what_is_stated(const Finding& finding, const Answered& answered,
                           const ClockCheckOptions& options) {
  if (finding.code != "clock_offset" || !finding.value || !(std::abs(*finding.value) <= options.widest))
    return false;
  // what the clock moves is in there already
  Answered by_motions = answered;
  by_motions.timing_stddev = {};
  return in_stated_stddevs(finding, by_motions) < two_sided_95;
}

/// Both streams inverted, and a mounting that moved once (inverted_and_moved()), fit better than one mounting
/// as given, in both measures: right streams do not look like that, those of which the wrong one was inverted
/// do. There is no margin: such streams gain little, of ten below 1.35 in eight, and of 370 clean drives one
/// has more than 1 (1.23, 20 s with noise that wanders).
bool moved_if_inverted(const Finding& finding) {
  return finding.code == "inverted_both" && finding.time && finding.improvement > 1;
}

/// Headings that may wander, at no constant rate: how far that moves the answer is in its standard
/// deviations.
bool wanders(const Finding& finding) {
  return finding.code.starts_with("turning_drift_") && !finding.certain && !finding.value;
}

/// Another answer that fits as well makes this one doubtful, unless it is the usual price of one more
/// unknown.
bool casts_doubt(const Finding& finding) {
  if (wanders(finding)) return false;
  if (moved_if_inverted(finding)) return true;
  return finding.code != "inverted_both" && finding.code != "reversed_steps" && finding.code != "scale" &&
         finding.code != "clock_offset" && finding.code != "clock_drift";
}

/// A change of the mounting that may as well be noise that wanders, to an answer that this one is near: the
/// two cannot be told apart, and it matters little which it is. Where both streams may be read in another
/// way, what seems to move a little is a sign that they are.
bool slight_move(const Finding& finding, double far, const std::vector<Finding>& findings) {
  return finding.code == "mount_moved" && !finding.certain && finding.T_a_b && far <= near &&
         std::none_of(findings.begin(), findings.end(),
                      [](const Finding& one) { return one.code.ends_with("_both"); });
}

/// A scale that changes by what noise that wanders may look like, to an answer that this one is near.
bool slight_scale_change(const Finding& finding, double far) {
  return finding.code == "scale_change" && !finding.certain && finding.T_a_b && far <= near;
}

/// Another reading fits far better and has another answer. Which one it is may be open, not that the streams
/// as given are wrong.
bool refutes(const Finding& finding, double far, const DiagnosisOptions& options) {
  const bool reading = finding.code == "inverted_a" || finding.code == "inverted_b" ||
                       finding.code.starts_with("quaternion_order_");
  return reading && far > 1 && finding.improvement > options.overwhelming;
}

/// A clock that was set during the drive: no one offset is right.
bool clock_step(const Finding& finding) {
  return finding.certain && finding.code == "clock_step";
}

bool shows_all(const Observability& observability) {
  const auto& seen = observability.observable;
  return std::all_of(seen.begin(), seen.end(), [](bool one) { return one; });
}

struct Opinion {
  Verdict verdict = Verdict::good;
  std::string reason;
};

Opinion of_findings(const Diagnosis& diagnosis, const Answered& answered, const DiagnosisOptions& options) {
  Opinion worst;
  for (const Finding& finding : diagnosis.findings) {
    Verdict verdict = Verdict::good;
    const double far = far_off(finding, answered, options);
    const bool certain = certain_of_either(finding);
    const double apart = certain && !within_what_is_stated(finding, answered, options.clock_check) ? far : 0;
    if (finding.code == "too_little_motion" || shows_too_little(finding))
      verdict = Verdict::incomplete;
    else if (undersampling(finding))
      verdict = Verdict::good;  // what is unknown by it counts as unknown
    else if (wrong_nominal(finding))
      verdict = shows_all(answered.observability) ? Verdict::good : Verdict::doubtful;
    else if (stream_fault(finding))
      verdict = finding.code.starts_with("frozen_") ? Verdict::good : Verdict::doubtful;
    else if (misread(finding) || refutes(finding, far, options) || apart > 1 ||
             (certain && finding.improvement > options.overwhelming && !drifts(finding)))
      verdict = Verdict::contradictory;
    else if ((finding.code == "mount_moved" && !slight_move(finding, far, diagnosis.findings)) ||
             (finding.code == "scale_change" && !slight_scale_change(finding, far)) || clock_step(finding) ||
             finding.code.starts_with("plane_") || apart > near ||
             significant_scale(finding, answered, options.scale_check) || (casts_doubt(finding) && far > 1))
      verdict = Verdict::doubtful;
    if (verdict > worst.verdict) worst = {verdict, finding.message};
  }
  return worst;
}

Opinion of_fit(const Misfit& misfit, const Answered& answered, const DiagnosisOptions& options) {
  if (misfit.at_answer > options.doubtful_misfit) {
    const bool contradictory = misfit.at_answer > options.contradictory_misfit;
    return {contradictory ? Verdict::contradictory : Verdict::doubtful,
            format("These motions contradict each other: %.0f %% of the typical motion is not explained.",
                   100 * misfit.at_answer)};
  }
  if (misfit.median > options.half_contradicts && misfit.at_answer > options.not_outliers)
    return {Verdict::doubtful,
            format("These motions agree badly: half of them leave more than %.0f %% unexplained.",
                   100 * misfit.median)};
  const PairingCounts& counts = answered.counts;
  const double incongruent =
      static_cast<double>(counts.rejected[static_cast<std::size_t>(Rejection::screw_congruence)]);
  if (counts.synchronised > 0 && 2 * incongruent > static_cast<double>(counts.synchronised))
    return {Verdict::doubtful,
            format("Most poses were rejected: %.0f of %.0f make motions that no rigid mounting explains.",
                   incongruent, static_cast<double>(counts.synchronised))};
  // of motion pairs that were given the poses are not known
  const double given = static_cast<double>(counts.matched + counts.outliers) + incongruent;
  if (counts.synchronised == 0 && 2 * incongruent > given)
    return {Verdict::doubtful, format("Most motion pairs were rejected: %.0f of %.0f fit no rigid mounting.",
                                      incongruent, given)};
  return {};
}

}  // namespace

DiagnosisOptions in_unit_of(const Motions& motions, DiagnosisOptions options) {
  if (options.unit != LengthUnit::unknown || !(motions.rotation > 0)) return options;
  options.tolerance_translation = options.tolerance_rotation * motions.translation / motions.rotation;
  return options;
}

void judge(Diagnosis& diagnosis, const Answered& answered, const Misfit& misfit,
           const DiagnosisOptions& options) {
  name_longest_gap(answered.counts, diagnosis.findings);
  const Opinion fit = of_fit(misfit, answered, options);
  // an answer that is wrong itself, or noise, contradicts a right nominal value
  const auto contradicts_itself = [&](const Finding& one) {
    const bool moved =
        one.code == "mount_moved" && !slight_move(one, far_off(one, answered, options), diagnosis.findings);
    const bool changes =
        one.code == "scale_change" && !slight_scale_change(one, far_off(one, answered, options));
    return one.code == "too_little_motion" || moved || changes ||
           (certain_of_either(one) && !stream_fault(one) && !undersampling(one) && !shows_too_little(one));
  };
  if (fit.verdict < Verdict::doubtful &&
      std::none_of(diagnosis.findings.begin(), diagnosis.findings.end(), contradicts_itself))
    if (std::optional<Finding> nominal = contradicted_nominal(answered, options))
      diagnosis.findings.push_back(*std::move(nominal));
  const Opinion of_explanations = of_findings(diagnosis, answered, options);
  if (options.goal) diagnosis.goal = goal_of(answered, *options.goal, options.goal_spread);
  const Opinion& worse = fit.verdict > of_explanations.verdict ? fit : of_explanations;
  diagnosis.verdict = worse.verdict;
  diagnosis.reason = worse.reason;
  if (&worse == &fit)
    for (const Finding& finding : diagnosis.findings)
      if (stream_fault(finding) || finding.code == "samples") {
        diagnosis.reason = finding.message;
        break;
      }
  const std::array<double, 6> unstable =
      spread_without_fifths(answered.problem, answered.T_a_b, options.stability);
  add_spread_of_unstable(unstable, answered, options, diagnosis);
  if (diagnosis.verdict >= Verdict::doubtful) return;
  const Known known = known_to(answered, unstable, options);
  const auto says_why = std::find_if(
      diagnosis.findings.begin(), diagnosis.findings.end(),
      [](const Finding& one) { return one.code == "too_little_motion" || shows_too_little(one); });
  if (says_why != diagnosis.findings.end()) {
    diagnosis.verdict = Verdict::incomplete;
    diagnosis.reason = says_why->message + " " + says_why->remedy;
  } else if (!known.unknown.empty()) {
    diagnosis.verdict = Verdict::incomplete;
    diagnosis.reason = not_known_yet(known, options);
    if (!diagnosis.goal && answered.seconds > 0) {
      const GoalOptions usable{options.tolerance_rotation / length_of_three,
                               options.tolerance_translation / length_of_three, options.platform};
      if (const std::string next = goal_of(answered, usable, options.goal_spread).next; !next.empty())
        diagnosis.reason += " " + next;
    }
  } else if (diagnosis.goal && !diagnosis.goal->reached) {
    diagnosis.verdict = Verdict::incomplete;
    diagnosis.reason = "The motions agree; the goal is not reached yet.";
  } else if (diagnosis.reason.empty()) {
    diagnosis.reason = format("The motions agree to %.2g %%, and all directions %s.", 100 * misfit.at_answer,
                              answered.problem.mode == Mode::planar
                                  ? "in the plane are known; height, roll and pitch are as good as the "
                                    "ground planes"
                                  : "are known");
  }
}

}  // namespace detail

}  // namespace egocal
