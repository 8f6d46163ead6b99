// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/both_lists.hpp"

#include <cmath>
#include <string>

#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "samples/readings.hpp"

namespace egocal::detail {

namespace {

double squared_positions(const SampleSet& set, const AgreeingSamples& agreeing) {
  double sum = 0;
  for (const std::size_t i : agreeing.chosen) sum += squared_residual(set, i, agreeing.fit).translation;
  return sum;
}

/// likelier: of the lists as they are given, by the noise.
Finding worded_both(Finding finding, double likelier, const BothListsOptions& options) {
  FindingWords words;
  words.claim = "If both lists are inverted, the answer is another one, as camera and target change places";
  words.evidence = likelier < -options.least_likelier ? "; the noise of the samples suits that better."
                   : likelier > options.least_likelier
                       ? "; the noise of the samples suits them as given, but the camera is "
                         "further from the hand than the target from the base."
                       : "; the motions cannot tell.";
  words.scope =
      "Make sure that {a} has the hand in the base, {b} the camera in the target, and that the camera is "
      "where --eye-in-hand or --eye-to-hand says; otherwise ";
  words.cure = "{solve}--invert-a --invert-b";
  say(finding, std::move(words));
  return finding;
}

}  // namespace

std::optional<Finding> both_inverted(std::span<const PoseSample> samples, const SampleSet& set,
                                     const AgreeingSamples& given, const SampleOptions& options,
                                     const BothListsOptions& both) {
  constexpr std::size_t least = 4;  // fewer leave no residuals to compare
  if (given.chosen.size() < least) return std::nullopt;
  const Eigen::Vector3d X = to_pose(given.fit.X).translation,
                        Y = to_pose(given.fit.Y).translation + set.middle();
  const bool X_is_long = X.norm() > both.clearly_longer * Y.norm(),
             X_is_short = both.clearly_longer * X.norm() < Y.norm();
  // --eye-to-hand inverts a: there X is long and Y short, whichever list is inverted
  const bool on_the_hand = !options.read_a.invert;
  if (on_the_hand && X_is_short) return std::nullopt;
  Reading inverted;
  inverted.invert = true;
  std::vector<PoseSample> chosen;
  for (const std::size_t i : given.chosen) chosen.push_back(samples[i]);
  const SampleSet other_set(reread(chosen, inverted, inverted));
  AgreeingSamples other;
  for (std::size_t i = 0; i < chosen.size(); ++i) other.chosen.push_back(i);
  other.fit = fit_of_all(other_set, options);
  const double squares = squared_positions(set, given), others = squared_positions(other_set, other);
  if (!(squares > 0) || !(others > 0)) return std::nullopt;
  // the rotations differ by as much under both readings
  const double dof = 3 * static_cast<double>(set.units_among(given.chosen)) - 6;
  const double likelier_as_given = 0.5 * dof * std::log(others / squares);

  const bool X_fits_badly = on_the_hand && X_is_long;
  if (!X_fits_badly && likelier_as_given > both.least_likelier) return std::nullopt;
  Finding finding;
  finding.code = "inverted_both";
  finding.improvement = squares / others;
  finding.T_a_b = to_pose(other.fit.X);
  return worded_both(std::move(finding), likelier_as_given, both);
}

std::optional<Finding> not_in_metres(const SampleSet& set, const SampleFit& fit, const SampleOptions& options,
                                     const BothListsOptions& both) {
  if (options.diagnosis.unit != LengthUnit::metres || !(set.length() > both.unlikely)) return std::nullopt;
  constexpr double millimetre = 1e-3;  // [m], the usual unit of such lists
  Finding finding;
  finding.code = "units";
  finding.certain = set.length() > both.impossible;
  finding.T_a_b = to_pose(fit.X);
  finding.T_a_b->translation *= millimetre;
  FindingWords words;
  words.claim = finding.certain ? "The lengths of both lists are not in metres"
                                : "The lengths of both lists may not be in metres";
  words.evidence = format(": the positions are %s from each other and the camera from the target, typically.",
                          length_in_words(set.length()).c_str());
  words.cure = "Give the positions of both lists in metres.";
  say(finding, std::move(words));
  return finding;
}

}  // namespace egocal::detail
