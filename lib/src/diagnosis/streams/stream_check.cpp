// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/streams/stream_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/streams/flat.hpp"
#include "diagnosis/streams/rounded_copy.hpp"
#include "diagnosis/streams/step_size.hpp"
#include "diagnosis/streams/two_senders.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/pairing/match_samples.hpp"
#include "uncertainty/frame_a.hpp"

namespace egocal::detail {

namespace {

struct Steps {
  std::size_t all = 0, equal = 0;           ///< steps; of these the same in both streams
  std::size_t frozen_a = 0, frozen_b = 0;   ///< one pose repeated while the other one moves
  double travelled_a = 0, travelled_b = 0;  ///< size of the other stream's motion meanwhile
  double travelled = 0;                     ///< size of all motions
};

Steps steps_of(const Instants& instants, const StreamCheckOptions& options) {
  Steps steps;
  const std::size_t n = instants.size();
  const std::size_t each = std::max<std::size_t>(1, n / options.most);
  for (std::size_t i = 0; i + 1 < n; i += each) {
    const PosePair from = instants.at(i), to = instants.at(i + 1);
    const DualQuaternion a = canonical_sign(conjugate(from.a) * to.a),
                         b = canonical_sign(conjugate(from.b) * to.b);
    const double size_a = step_size(a), size_b = step_size(b);
    const bool still_a = size_a < rounding_of(from.a, options.rounding),
               still_b = size_b < rounding_of(from.b, options.rounding);
    if (still_a && still_b) continue;
    ++steps.all;
    steps.travelled += std::max(size_a, size_b);
    // digits of a file: with coordinates of a map these may be those of a motion
    const double digits = options.same * (1 + from.a.dual.norm() + from.b.dual.norm());
    const double alike =
        std::max(rounding_of(from.a, options.rounding) + rounding_of(from.b, options.rounding),
                 std::min(digits, options.same_part * std::max(size_a, size_b)));
    if ((a.vec() - b.vec()).norm() < alike) ++steps.equal;
    if (still_a) {
      ++steps.frozen_a;
      steps.travelled_a += size_b;
    }
    if (still_b) {
      ++steps.frozen_b;
      steps.travelled_b += size_a;
    }
  }
  return steps;
}

Finding frozen(char which, double part) {
  Finding finding;
  finding.code = std::string("frozen_") + which;
  finding.certain = true;
  say(finding,
      format("%s repeats its pose during %.0f %% of the way that the other one travels: it is frozen or "
             "has no new poses.",
             mark(which), 100 * part),
      format("Look at the odometry of %s; use the part of the drive where both move.", mark(which)));
  return finding;
}

/// A stream of which one half never changes while the other sensor has it: positions that were never filled
/// in, rotations that are all the identity.
std::optional<Finding> without_part(char which, const Trajectory& own, const Trajectory& other,
                                    const StreamCheckOptions& options) {
  struct Sizes {
    double travelled = 0, turned = 0;
    double rounding = 0;  ///< of either
  };
  const auto sizes = [&](const Trajectory& trajectory) {
    Sizes sum;
    const std::size_t each = std::max<std::size_t>(1, trajectory.size() / options.most);
    for (std::size_t i = 0; i + each < trajectory.size(); i += each) {
      const DualQuaternion motion = conjugate(trajectory[i].pose) * trajectory[i + each].pose;
      sum.travelled += motion.dual.norm();
      sum.turned += motion.real.tail<3>().norm();
      sum.rounding += rounding_of(trajectory[i].pose, options.rounding);
    }
    return sum;
  };
  if (own.size() < options.least || other.size() < options.least) return std::nullopt;
  const Sizes here = sizes(own), there = sizes(other);
  // to rounding as well: poses that were inverted far from their origin travel a million times as far
  const bool travels = here.travelled > std::min(options.flat * there.travelled, here.rounding);
  const bool turns = here.turned > options.flat * there.turned;
  const bool no_positions = !travels && turns && there.travelled > there.rounding;
  const bool no_rotations = !turns && travels && there.turned > options.least_tilt;
  if (no_positions == no_rotations) return std::nullopt;
  Finding finding;
  finding.code = std::string("missing_") + which;
  finding.certain = true;
  say(finding,
      format("The %s of %s never change although %s: they are missing.",
             no_positions ? "positions" : "rotations", mark(which),
             no_positions ? "the other sensor travels" : "the other sensor turns"),
      format("Give poses of %s with positions and rotations.", mark(which)));
  return finding;
}

Finding samples() {
  Finding finding;
  finding.code = "samples";
  say(finding, "These look like still poses of an arm rather than streams.", "{solve}--samples");
  return finding;
}

}  // namespace

Finding same_stream() {
  Finding finding;
  finding.code = "same_stream";
  finding.certain = true;
  finding.message = "Both streams are the same to rounding: one sensor was given twice.";
  finding.remedy = "Give the poses of the other sensor.";
  finding.T_a_b = Pose{};
  return finding;
}

std::vector<Finding> check_streams(const Trajectory& a, const Trajectory& b, const Instants& instants,
                                   const StreamCheckOptions& options) {
  std::vector<Finding> findings;
  if (look_like_samples(a, b)) findings.push_back(samples());
  const Steps steps = steps_of(instants, options);
  if (steps.equal >= options.least && steps.equal == steps.all) findings.push_back(same_stream());
  const auto check = [&](char which, std::size_t count, double travelled) {
    if (count < options.least || !(travelled > options.least_frozen * steps.travelled)) return;
    findings.push_back(frozen(which, travelled / steps.travelled));
  };
  for (const char which : {'a', 'b'}) {
    if (std::optional<Finding> found = which == 'a' ? flat(a, Side::a, instants) : flat(b, Side::b, instants))
      findings.push_back(*std::move(found));
    if (std::optional<Finding> missing =
            which == 'a' ? without_part('a', a, b, options) : without_part('b', b, a, options))
      findings.push_back(*std::move(missing));
    if (std::optional<Finding> mixed = which == 'a' ? two_senders(Side::a, a, b, options.metres)
                                                    : two_senders(Side::b, b, a, options.metres))
      findings.push_back(*std::move(mixed));
  }
  check('a', steps.frozen_a, steps.travelled_a);
  check('b', steps.frozen_b, steps.travelled_b);
  if (findings.empty())
    if (std::optional<Finding> copy = rounded_copy(a, b, instants, options.metres))
      findings.push_back(*std::move(copy));
  return findings;
}

std::vector<Finding> in_one_frame(const Answered& answered, const StreamCheckOptions& options) {
  const Vector6d x = frame_a_difference(DualQuaternion{}, answered.T_a_b);
  const Observability& seen = answered.observability;
  int known_translations = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const bool known =
        seen.observable[i] && seen.stddev[i] < (i < 3 ? options.known_translation : options.known_rotation);
    if (!known && i < 3) continue;
    if (!known || !(std::abs(x[static_cast<Eigen::Index>(i)]) <=
                    std::max(i < 3 ? options.close : options.parallel, 3 * seen.stddev[i])))
      return {};
    if (i < 3) ++known_translations;
  }
  if (known_translations < 2) return {};
  Finding finding;
  finding.code = "same_stream";
  finding.message = format(
      "The answer is the identity to %.2f deg and %s: both streams may be of one frame, such as that of the "
      "vehicle.",
      x.tail<3>().norm() * degrees_per_radian, length_in_words(x.head<3>().norm(), options.metres).c_str());
  finding.remedy =
      "Give the poses of the sensors themselves, not moved to a common frame; ignore this where the sensors "
      "really sit side by side and look the same way.";
  return {finding};
}

std::vector<Finding> made_from_each_other(const Fit& fit, const StreamCheckOptions& options) {
  if (fit.rotation_median > options.of_rounding || fit.translation_relative_median > options.of_rounding)
    return {};
  Finding finding;
  finding.code = "same_stream";
  finding.message =
      "The motions agree to rounding, as those of two sensors never do: one stream was made from the other, "
      "or both were simulated without noise.";
  finding.remedy = "Give what each sensor measured by itself; ignore this where the streams were simulated.";
  return {finding};
}

}  // namespace egocal::detail
