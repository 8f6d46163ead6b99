// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/nominal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/directions.hpp"
#include "egocal/uncertainty/observability.hpp"
#include "egocal/uncertainty/plane_directions.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

/// How far a nominal value is from the answer in the directions of one kind that are known without it.
struct Disagreement {
  double size = 0, limit = 1;  ///< [m or rad]
  std::string names{};         ///< of the directions, "x, y"
  double part() const { return size / limit; }
};

/// Disagreement of the translation and that of the rotation.
struct Disagreements {
  Disagreement translation, rotation;
  double part() const { return std::max(translation.part(), rotation.part()); }
};

/// What the motions show, or the ground planes give, and its standard deviation.
struct SeenDirections {
  std::array<bool, 6> directions{};
  std::array<double, 6> stddev{};  ///< 0 of what the planes give
};

SeenDirections known_without_nominal(const Answered& answered) {
  SeenDirections known{answered.observability.observable, answered.observability.stddev};
  for (std::size_t k = 0; k < 6; ++k) {
    known.directions[k] = known.directions[k] && std::isfinite(known.stddev[k]);
    if (answered.problem.mode != Mode::planar || in_plane(answered.problem.plane_a, k)) continue;
    known.directions[k] = true;
    known.stddev[k] = 0;
  }
  return known;
}

Disagreement disagreement(const Vector6d& difference, std::size_t first, double tolerance,
                          const SeenDirections& known, const NominalCheckOptions& check) {
  Disagreement result;
  double squares = 0, variance = 0;
  for (std::size_t k = first; k < first + 3; ++k) {
    if (!known.directions[k]) continue;
    squares += std::pow(difference[static_cast<Eigen::Index>(k)], 2);
    variance += known.stddev[k] * known.stddev[k];
  }
  result.size = std::sqrt(squares);
  result.limit = tolerance + check.sigmas * std::sqrt(variance);
  for (std::size_t k = first; k < first + 3; ++k)
    if (known.directions[k] &&
        std::abs(difference[static_cast<Eigen::Index>(k)]) > check.least_part * result.size)
      result.names += (result.names.empty() ? "" : ", ") + std::string(direction_names[k]);
  return result;
}

/// The answer is taken from the nominal value along the hidden directions, so what is left between the two is
/// in the others. Both in the frame of a.
Disagreements disagreements_of(const Pose& nominal, const Answered& answered, const DiagnosisOptions& options,
                               const NominalCheckOptions& check) {
  Problem problem = answered.minimised.blocks.empty() ? answered.problem : answered.minimised;
  problem.prior = to_dual_quaternion(nominal);
  const Vector6d difference = frame_a_difference(solve(problem, Method::dual).T_a_b, *problem.prior);
  const ObservabilityOptions drawing;
  const SeenDirections known = known_without_nominal(answered);
  Disagreements result;
  // lengths of an unknown unit cannot be compared with metres
  if (options.unit != LengthUnit::unknown)
    result.translation = disagreement(
        difference, 0, std::max(options.tolerance_translation, check.sigmas * drawing.prior_translation),
        known, check);
  result.rotation =
      disagreement(difference, 3, std::max(options.tolerance_rotation, check.sigmas * drawing.prior_rotation),
                   known, check);
  return result;
}

/// "30 deg (roll, pitch, yaw) and 2.83 m (x, y)": those beyond their limits.
std::string in_words(const Disagreements& disagreements) {
  std::string text;
  const Disagreement &turn = disagreements.rotation, &shift = disagreements.translation;
  if (turn.part() > 1) text = format("%.3g deg (%s)", turn.size * degrees_per_radian, turn.names.c_str());
  if (shift.part() > 1)
    text += (text.empty() ? "" : " and ") + length_in_words(shift.size) + " (" + shift.names + ")";
  return text;
}

/// The quaternion x y z w that was taken for w x y z.
Pose with_scalar_last(const Pose& T) {
  const auto& q = T.rotation;
  return {Rotation(q.z(), q.w(), q.x(), q.y()), T.translation};
}

/// What would make the nominal value agree; empty: nothing that is known.
std::string agreeing_reading(const Pose& nominal, double part, const Answered& answered,
                             const DiagnosisOptions& options, const NominalCheckOptions& check) {
  std::vector<std::pair<Pose, const char*>> readings = {
      {inverse(nominal), "whose inverse agrees: give the pose of {b} in {a}, not that of {a} in {b}"},
      {with_scalar_last(nominal), "whose quaternion agrees as x y z w: give w x y z"}};
  if (nominal.translation.norm() > check.least_millimetres)
    readings.push_back(
        {{nominal.rotation, nominal.translation / 1000}, "which agrees in millimetres: give metres"});
  for (const auto& [reading, words] : readings) {
    const double left = disagreements_of(reading, answered, options, check).part();
    if (left <= 1 && left < check.much_nearer * part) return words;
  }
  return "";
}

/// ", so z, which is taken from it, is not known": of the directions that are hidden. In planar mode nothing
/// is: what the motions hide is the planes'.
std::string what_is_taken(const Answered& answered) {
  if (answered.problem.mode == Mode::planar) return "";
  const Observability& shown = answered.observability;
  std::string names;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 6; ++k)
    if (!shown.observable[k]) {
      names += (names.empty() ? "" : ", ") + std::string(direction_names[k]);
      ++count;
    }
  if (count == 0) return "";
  return ", so " + names + ", which " + (count > 1 ? "are" : "is") + " taken from it, " +
         (count > 1 ? "are" : "is") + " not known";
}

Finding worded(const std::string& claim, const std::string& cure) {
  Finding finding;
  finding.code = "nominal";
  finding.certain = true;
  say(finding, claim, cure);
  return finding;
}

}  // namespace

std::optional<Finding> contradicted_nominal(const Answered& answered, const DiagnosisOptions& options,
                                            const NominalCheckOptions& check) {
  if (!answered.problem.prior) return std::nullopt;
  const Pose nominal = to_pose(*answered.problem.prior);
  const Disagreements disagreements = disagreements_of(nominal, answered, options, check);
  const std::string taken = what_is_taken(answered);
  const double length = nominal.translation.norm();
  const bool planar = answered.problem.mode == Mode::planar;
  const bool is_long = options.unit != LengthUnit::unknown && length > check.longest;
  const std::string in_metres =
      "Give the nominal value in metres: it is " + length_in_words(length) + " long; is it in millimetres?";
  if (disagreements.part() > 1) {
    const std::string agrees = agreeing_reading(nominal, disagreements.part(), answered, options, check);
    return worded(
        "The nominal value is " + in_words(disagreements) + " from what " +
            (planar ? "the ground planes and " : "") + "the motions show" + taken + ".",
        !agrees.empty() ? "Correct the nominal value, " + agrees + "."
        : is_long       ? in_metres
        : planar
            ? "Correct the nominal value, the pose of {b} in {a}, or the ground planes: one of them is wrong."
            : "Correct the nominal value, the pose of {b} in {a}. Where only a part of it "
              "is measured, give what this answer has in the other directions, or nan to solve.");
  }
  if (taken.empty() || !is_long) return std::nullopt;
  return worded("The nominal value is " + length_in_words(length) + " long" + taken + ".", in_metres);
}

}  // namespace egocal::detail
