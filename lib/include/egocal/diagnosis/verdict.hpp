// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/geometry/pose.hpp"

namespace egocal {

/// Whether an answer can be used. A certificate says that no other extrinsic has a lower cost; it does not
/// say that the motions are those of rigidly mounted sensors. This does.
enum class Verdict {
  good,           ///< the motions agree, and every direction is known well enough
  incomplete,     ///< the motions agree; some direction is not known well enough yet
  doubtful,       ///< the motions agree badly, or another reading of them would give another answer
  contradictory,  ///< the motions contradict each other, or another explanation fits clearly better
};
std::string_view to_string(Verdict verdict);

/// Agreement in one consecutive tenth of the drive. NaN where it has no motion.
struct FitTenth {
  double begin = 0, end = 0;        ///< since the first pose of a [s]
  double rotation_median = 0;       ///< residual [rad]
  double translation_median = 0;    ///< residual [m]
  double translation_relative = 0;  ///< residual as a part of the distance travelled; NaN at rest
};

/// How well the answer explains the motions: residuals of R_a T = T R_b and of the translations, of motions
/// over `motion_seconds`. Gross outliers among them count; the medians do not feel them.
struct Fit {
  double rotation_median = 0, rotation_95 = 0;        ///< [rad]
  double translation_median = 0, translation_95 = 0;  ///< [m]
  double translation_relative_median = 0;             ///< residual / mean length of the two motions
  double length_ratio = 1;    ///< distance of b / of a; far from 1: units, or a camera without scale
  double turning_ratio = 1;   ///< angle of b / of a; 1 for every rigid mounting
  double motion_seconds = 0;  ///< typical duration of the motions [s]
  std::vector<FitTenth> tenths;
};

/// What a finding says, in parts: no program has to search in its sentences. {a} and {b} stand for the
/// streams, {solve} for the command before an option of `egocal solve`. Empty where the message is the same
/// for everybody, and where the finding came over the bus.
struct FindingWords {
  std::string claim;     ///< the message is claim and evidence
  std::string evidence;  ///< from the mark after the claim to the end; may be empty
  std::string scope;     ///< the remedy is scope and cure; empty: of the whole drive
  std::string cure;
};

/// How a mounting changed.
enum class MountingChange {
  at_once,
  slowly,
  back,  ///< at once, to where it was before the change before
};

/// Something found in the streams: another explanation that fits better or as well, or a fault.
struct Finding {
  /// inverted_a|_b|_both, quaternion_order_a|_b|_both, scale, units, scale_change, clock_offset, clock_drift,
  /// time_unit, stamps_a|_b, axes_a|_b|_both, late_positions_a|_b, turning_scale_a|_b, turning_drift_a|_b,
  /// plane_a|_b, mount_moved, unrelated, frozen_a|_b, missing_a|_b|_both, flat_a|_b|_both, same_stream,
  /// samples, wrong_samples, undersampled_a|_b, held_a|_b, mixed_frames_a|_b, odometry, nominal, filled_a|_b,
  /// reversed_steps, clock_step, too_little_motion. docs/findings.md says what each means.
  std::string code;
  bool certain = false;       ///< it fits clearly better; otherwise both remain possible
  std::string message;        ///< what was found, one sentence
  std::string remedy;         ///< option or action that cures it
  double improvement = 1;     ///< squared residuals as given / under this explanation
  std::optional<Pose> T_a_b;  ///< the answer under this explanation, where it has one
  /// mount_moved, scale_change (but of lengths that are lost in turns), unrelated, filled_a|_b, clock_step,
  /// and inverted_both where the mounting would have moved at that time: since the first pose of a [s].
  std::optional<double> time;
  std::optional<double> value;  ///< scale and units: factor of b's lengths; clock_offset: added to b [s];
                                ///< clock_step: how much more is added to b from then on [s];
                                ///< clock_drift: rate of b's clock against a's [s/s]; late_positions_a|_b:
                                ///< how late they are [s]; time_unit, turning_scale_a|_b: factor; held_a|_b:
                                ///< new ones a second; turning_drift_a|_b: the rate [rad/s]
  FindingWords words{};         ///< of message and remedy, for those who name the streams
  std::optional<MountingChange> change{};  ///< mount_moved: how, where that is known
};

/// What carries the sensors: which manoeuvres can be asked for.
enum class Platform { car, handheld, drone, arm };
std::string_view to_string(Platform platform);
std::optional<Platform> platform_from_name(std::string_view name);

/// How well each direction is to be known.
struct GoalOptions {
  double rotation = 0;     ///< one standard deviation of roll, pitch and yaw [rad]
  double translation = 0;  ///< of x, y and z [m]
  std::optional<Platform>
      platform;  ///< empty: a car where the sensors always travel the same way of their bodies
};
/// "0.1deg,2cm": rotation (deg or rad), translation (mm, cm or m), both above 0. Empty: not understood.
std::optional<GoalOptions> goal_from_text(std::string_view text);

/// Where the drive is on its way to the goal.
struct Goal {
  bool reached = false;
  std::vector<std::string> missing;    ///< of x y z roll pitch yaw, worst first
  std::optional<double> seconds_left;  ///< at this kind of driving; empty where more of it would not help
  std::string next;                    ///< the manoeuvre that helps most, for a driver; empty when reached
};

/// All of it.
struct Diagnosis {
  Verdict verdict = Verdict::incomplete;
  std::string reason;  ///< of the verdict, one line
  Fit fit;
  std::vector<Finding> findings;  ///< most important first
  std::optional<Goal> goal;       ///< where one was given
  /// What the times and digits of the poses add to the standard deviations of the answer (x y z roll pitch
  /// yaw in sensor a's frame [m, rad]): the interpolation of one stream at the stamps of the other one,
  /// clocks that differ, positions or rotations of another time, a small scale that the motions do not
  /// exclude, rounding, and the change without a fifth of the drive where a direction hinges on it. To be
  /// added as squares; 0 where they add nothing.
  std::array<double, 6> timing_stddev{};
  /// Directions that both streams assume and neither measured (flat_both), in the same order: the motions
  /// agree about them without an error, and they are not observable.
  std::array<bool, 6> assumed{};
};

}  // namespace egocal
