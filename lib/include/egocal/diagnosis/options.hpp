// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Every number that the diagnosis decides by. "Study" is tests/bench/mistake_study.cpp: mistakes of users on
// real and simulated drives, and the same drives without any; docs/trust_measured.md has its tables.
#pragma once

#include <cstddef>
#include <optional>

#include "egocal/diagnosis/verdict.hpp"

namespace egocal {

/// The motions that explanations are compared on.
struct MotionSampleOptions {
  std::size_t most = 700;        ///< motions that decide; bounds the cost of a drive of any length
  std::size_t first_look = 200;  ///< motions that choose which explanations are worth a closer look
  double most_rotation =
      2.9670597283903604;        ///< [rad], 170 degrees: nearer to half a turn the sign is a guess
  std::size_t most_blocks = 64;  ///< independent parts of a drive that a comparison counts, at most
  double most_stretched = 4;     ///< a motion of more than this many times its usual duration crosses a gap
  std::size_t most_periods = 1000;  ///< distances of stamps that show the usual one: its median to 3 %
  std::size_t time_parts = 10;      ///< parts of the drive whose residuals are reported (Fit::tenths)
  /// Fewer motions are explained by anything: six unknowns, two equations of three each.
  std::size_t least = 5;
};

/// Iteratively reweighted fit.
struct RobustFitOptions {
  int rounds = 4;        ///< of reweighting; the weights of gross outliers are negligible after three
  int quick_rounds = 2;  ///< of a first look, which only orders the explanations
  double inlier =
      9;  ///< squares beyond this many times the typical one lose weight: three standard deviations
};

/// Search for the clock of b.
struct ClockSearchOptions {
  std::size_t grid = 1200;  ///< points of the turning rates that are correlated, at most
  /// Instants that each trial of a clock looks at, about: ten for each motion that is compared.
  std::size_t instants = 7000;
  double widest = 60;        ///< offsets up to this are looked for [s],
  double widest_part = 0.5;  ///< and up to this part of the drive: the streams must share the other half
  std::size_t pieces = 6;    ///< of the drive, whose own offsets show the rate
  /// Offsets below this are not named for fitting better [s]: motions without noise fit better at a clock
  /// that is right to 0.05 ms, and stamps of sensors are not defined better. What such an offset changes of
  /// an answer is for ClockCheckOptions to decide. A test: AClockThatIsRightToTensOfMicrosecondsIsRight.
  double least = 2e-4;
  double most_rate = 0.02;  ///< a clock that is wrong by more is not believed [s/s]; crystals are within 1e-4
};

/// Search for the scale of b.
struct ScaleSearchOptions {
  /// Scales are looked for within this factor of the ratio of the lengths: a rig that turns much and travels
  /// little has unlike lengths.
  double widest = 64;
  int grid = 48;         ///< scales of the first look, evenly in the logarithm
  int refinements = 24;  ///< steps of the golden section after it: to 3e-6 of the scale
  double unit_tolerance =
      0.1;  ///< logarithm of what a scale may differ from a power of 1000 to be called a unit
  /// Of two units the one with the larger numbers is wrong: millimetres are common. Where that would leave a
  /// typical speed below this, both are named, as the other one may be in kilometres [m/s]. Sensors that are
  /// carried or driven go faster, most arms do.
  double slowest = 0.02;
};

/// Whether the scale of b differs from one by its own estimate. Where a machine mostly turns in place, few
/// blocks of the drive hold the scale; the others fit any, and a test that counts blocks does not see it.
struct ScaleCheckOptions {
  /// Least distance of the logarithm of the scale from 0 [standard deviations]. Study (an independent
  /// simulator, docs/trust_measured.md): the largest of 2,588 drives whose scale is right has 3.5; of 126
  /// excavators whose scale is wrong by 5 % and more, and shows, all but one have more than 5. Real lidars
  /// and cameras reach 4.2 (KITTI), which `least` allows.
  double sigmas = 5;
  /// Least logarithm of a scale that is named or makes an answer doubtful by itself: odometries of real
  /// sensors differ by up to 1 % (KITTI 0.4 %, EuRoC 0.8 %), and interpolation leaves less than 0.1 %
  /// (docs/scale.md). A smaller one is named where the answer at it is more than the tolerance away, as on
  /// multirotors that move slowly: of 12 at 1.4 % four had such answers, of 12 at 1.0 none.
  double least = 0.015;
  std::size_t blocks = 32;  ///< of the jack-knife, at most: they show a spread to an eighth
  /// The scale that was fitted is solved again within this factor, for its spread. A limit on time: the
  /// minimum is known already.
  double widest = 4;
  /// Noise of single motions counts this many times in the standard deviation of the scale: that of motions
  /// one after the other is not independent where it wanders.
  double wandering = 2;
  /// The scale of motions of all lengths agrees with that of the long ones where their logarithms differ by
  /// at most this part, and counts where it is this many of its own standard deviations from one. Those of
  /// machines that are shaken faster than measured have 65 and more; of real devices up to 7 (Tango: 2.5 %).
  double agree = 0.3, sigmas_of_drive = 20;
  /// An answer is doubtful where the scale moves it by more than this many of its standard deviations in some
  /// direction: less is within what it states.
  double significant = 3;
  /// The same of a scale whose logarithm is at least `clear`: the standard deviations are then those of
  /// lengths that do not fit, up to seven times larger than at the right scale (an arm with a scale of 1.1).
  /// No drive with a right scale has a certain one so large (`least`).
  double significant_where_clear = 1, clear = 0.02;
};

/// What no sensor does: the times, or the lengths of both streams, are in another unit.
struct PaceCheckOptions {
  double most_rate = 2000;   ///< poses a second; inertial sensors have up to 1 kHz
  double most_speed = 1000;  ///< [m/s] in the median of both streams: no aircraft is faster
  double most_turning = 50;  ///< [rad/s] in the median: eight turns a second
  /// Cars and drones stay below the usual speed [m/s]. What is faster flies, and turns with less than ten
  /// times its weight: speed times turning is below most_acceleration [m/s^2] in this part of the motions.
  double usual_speed = 150, most_acceleration = 100, accelerated = 0.8;
  /// Usual distance of poses [s], in the middle of 1 kHz and 1 Hz: the unit that comes nearest is the likely
  /// one, as where text files are read.
  double usual_period = 0.06;
};

/// In which direction of their own bodies the sensors travel.
struct HeadingOptions {
  /// Length of the mean direction of travel: vehicles of the study have 0.95 to 1, hand-held rigs, drones and
  /// arms less than 0.6.
  double always = 0.9, seldom = 0.7;
  double least_turning = 1.5;  ///< in all [rad]; without turning every reading travels straight
};

/// Whether the ground planes suit the motions.
struct PlaneCheckOptions {
  double one_axis =
      10;  ///< ratio of the mean squares of the turns about the first and the second axis: a vehicle
  double aligned =
      0.9;  ///< cosine of the angle between axis and normal, 26 degrees; level roads are within a few
};

/// Search for a mounting that moved.
struct MountCheckOptions {
  /// Instants that the longer motions span, at least, where the answer used shorter ones: single steps alone
  /// mistake an odometry at rest for a mount that moved (EuRoC, 8 of its steps are 0.4 s).
  std::size_t least_stride = 8;
  std::size_t blocks = 32;  ///< of three motions each that share no time: enough to know their scatter
  /// Stated chance that a mount that did not move is called moved, in one look at one drive. In 120 h of
  /// simulated driving, 3,960 drives, the strongest evidence was below 1e-2 in 3, so the real chance is about
  /// a tenth (docs/moves.md). Looks that are repeated want less.
  double false_alarms = 2e-3;
  std::size_t most_motions = 20000;  ///< of long drives: overlapping motions say little that is new
  /// A move must have shown already this long before the end of the drive [s]; 0: need not. For looks that
  /// are repeated: the newest seconds are new each time, and heavy tails in them soon look like a move, once.
  double shown_before = 0;
  /// Both looks show the same move where its times differ by less [s], or lie in the other's interval: as
  /// close as bumps are located (docs/moves.md, "Measured").
  double same_time = 5;
  /// The interval of the time of a move is stated where it is longer [s]. Changes the message only.
  double long_interval = 10;
  /// Evidence of a move that no place explains makes the answer doubtful where its chance is smaller: of 98
  /// clean drives of 14 machines the strongest has 4e-7, of mounts that moved 1e-30 to 1e-280.
  double contradicting_times = 1e-20;
};

/// Standard deviations as they are compared with a goal, when it is reached, and the time left. Study:
/// tests/bench/goal_study.cpp and its --more kinds, checked on other drives (--first-seed 3001);
/// docs/trust_measured.md has its tables.
struct GoalSpreadOptions {
  /// Fewer blocks have no common factor of all directions: it would be known to a quarter only.
  std::size_t least_blocks = 8;
  /// Standard deviation of the logarithm of the common factor of the variances from n blocks, in units of
  /// sqrt(2 / (6 n)): 1 if the blocks were alike, 1.2 measured.
  double scatter = 1.2;
  /// The mean of squared changes by omitting a block over the square of their mean size, which scatters by a
  /// tenth less: 1.09 if the blocks were alike, 1.12 measured.
  double unequal = 1.12;
  /// Noise that does not wander: the common factor over what the squared residuals say of white noise, and
  /// the standard deviation of its logarithm over kinds of noise. 1.0 (white) to 1.36 (a part of each
  /// motion).
  double plain = 1.13, plain_scatter = 0.15;
  /// How probable such noise is before the drive is seen, and the range of the logarithm of the factor
  /// otherwise: wandering noise has 6 to 14. Results hardly depend on either.
  double plain_part = 0.5, range = 8;
  /// A direction whose log variance differs from the common one by d keeps this part of d where the noise
  /// wanders, none where it is plain. d from 20 blocks has a standard deviation of 0.33, and is about 1 for
  /// the height on a road, 0.2 otherwise.
  double own_part = 0.6;
  double reserve = 1.5;  ///< standard deviations of the common factor that are added
  /// The reported standard deviation is never overruled by more: three standard deviations of their ratio.
  double most_different = 1.5;
  /// A goal is reached where this is the probability that all directions are within `interval` goals.
  double probability = 0.95, interval = 1.96;
  /// Spreads fall with this power of the time. With it the median of the estimated to the real time left is
  /// one in the study.
  double exponent = 0.51;
  /// Time left over the time of the drive, at least: less says no more than that the goal is near, as spreads
  /// change by that part by chance. And the power with which one that is longer than the drive counts: mostly
  /// a direction was hardly shown yet, and other parts of a drive show it sooner. Both were chosen on 100
  /// drives of 25 kinds (docs/trust_measured.md, "Goals").
  double least_time_left = 0.15, power_of_long_times = 0.7;
};

/// Whether the answer stays where it is without a part of the drive.
struct StabilityOptions {
  std::size_t parts = 5;  ///< one is dropped at a time; fewer parts have no spread, more are as the blocks
};

/// Whether a mount that seems to move is the scale of an odometry that wanders.
struct WanderingScaleOptions {
  /// Largest scale over the smallest, as a logarithm: ordinary odometries differ by up to 1 %
  /// (ScaleCheckOptions).
  double most = 0.015;
  std::size_t parts = 4;  ///< of the drive that have a scale each, at least
  int rounds = 4;         ///< of scales and extrinsic in turn
};

/// How an answer changes where its motions are taken otherwise from the streams.
struct AnswerChangeOptions {
  std::size_t motions = 300;  ///< of each length, evenly spread over the drive: 2 ms
  int longer = 4;             ///< instants that the longer motions span, besides single ones
  double inlier = 0.25;       ///< least weight of a motion that counts (RobustFitOptions::inlier)
  std::size_t parts = 10;     ///< of the drive, whose own changes show what is chance
  std::size_t least = 3;      ///< motions in a part
  /// Most poses of a stream that are looked at, from the middle of a longer one: a limit on time and memory.
  std::size_t most_poses = 10'000;
};

/// Whether the interpolation of one stream changes the answer. Study: docs/method.md, "Interpolation".
struct UndersamplingOptions {
  std::size_t poses = 12;  ///< of the better interpolation (SynchroniserOptions::smooth_poses)
  double significant = 3;  ///< standard deviations of the change that may be chance
  double share = 1;        ///< standard deviation of the answer as a part of the rest of the change
  double matters = 1;      ///< of these, in standard deviations of the answer: more is a finding
};

/// Whether the clocks differ by so little that no single block of the drive shows it. Study:
/// docs/trust_measured.md.
struct ClockCheckOptions {
  /// Least distance of the offset from 0 [standard deviations]. Clean drives of the study stay below 3.8,
  /// real ones below 4.9 but for an arm whose clocks do differ.
  double sigmas = 5;
  double widest = 0.1;  ///< larger offsets are found by ClockSearchOptions [s]
  /// The corrected clock changes an answer from short motions by more than this many standard deviations of
  /// the answer, and by `significant` of its own: a first look.
  double first_look = 1, significant = 3;
  double matters = 2;           ///< standard deviations by which the answer itself changes, at least
  std::size_t instants = 1000;  ///< that the offset is estimated from: a limit on time
};

/// What the lengths of an answer are. A camera without scale measures in a unit of its own.
enum class LengthUnit {
  metres,
  metres_where_alike,  ///< where the scale that is estimated is near one: no sensor is named as the unscaled
                       ///< one
  unknown,
};

/// The unit where the lengths of one sensor were multiplied by an estimated scale.
LengthUnit unit_of_scaled(LengthUnit unit, double scale);

/// When an answer counts as known or as wrong.
struct DiagnosisOptions {
  /// Whether calibrate() tries other explanations. Where it does not, no answer is called good.
  bool enabled = true;
  /// An answer is not called good where its rotation or its translation as a whole may be off by more than
  /// this (95 %), and is called contradictory where a better explanation has an answer further away [rad, m].
  /// What users of vehicles call wrong; an arm wants less.
  double tolerance_rotation = 0.017453292519943295;
  double tolerance_translation = 0.6;
  /// Where the unit is not known to be metres, the tolerance of the translation is what changes the motions
  /// as much as tolerance_rotation does: that part of the way in which the sensors turn by a radian. Ordinary
  /// cars go 20 to 60 m in it, which makes 35 cm to 1 m.
  LengthUnit unit = LengthUnit::metres;
  /// Signed-rank test of an explanation against the streams as given, over up to 64 blocks of the drive. 3.5
  /// standard deviations are one false alarm in 2000 comparisons of streams that fit equally well.
  double sigmas = 3.5;
  /// Least mean log ratio of the squared residuals of an explanation that is called certain. Clean drives of
  /// the study stay below 0.1 for all explanations but "both inverted".
  double gain = 0.3;
  /// Least gain of one fitted number (scale, clock): ten times what it gains by chance in a hundred motions.
  double least_gain = 0.05;
  /// Readings of the files that are fitted in full after the first look, the most promising first.
  std::size_t followed = 3;
  /// Two readings whose gains differ by less are decided by the way that a vehicle travels, or not at all.
  double alike = 0.7;
  /// An explanation that leaves more than this part of the typical motion unexplained explains nothing.
  double explains = 0.5;
  /// "Both inverted" is ruled out where it fits worse by this factor (mean squares): noise that grows with
  /// the distance from the start. Real drives: EuRoC 1.6, Tango 1.2, raw KITTI 4, KITTI 25 to 73.
  double decisive = 3;
  /// "Both inverted" is certain where an odometry would jump this often under that reading, and the mounting
  /// as often as given: a mount that moved and fell back does it twice.
  std::size_t certain_jumps = 3;
  /// A jump is a step, or a run of them, whose residual is more than this many times the typical one; and at
  /// least this part of the largest, so that heavy tails beside one large jump are none.
  double jump = 5, part_of_largest_jump = 0.1;
  /// An explanation better by this factor (squared residuals) makes the streams as given useless, wherever
  /// its answer lies.
  double overwhelming = 7.4;
  /// Residual at the answer as a part of the typical motion. Clean drives with a noise of a tenth of every
  /// single motion stay below 0.35; streams that do not belong together are at 1 and more.
  double doubtful_misfit = 0.45, contradictory_misfit = 0.7;
  /// Half of the motions may contradict the answer where outliers do: the better third then fits as well as
  /// noise of a tenth of every motion allows (0.2). An answer is doubtful where more than half_contradicts of
  /// the median motion is unexplained, and more than not_outliers of the motions at the answer. Clean drives
  /// of the study stay below 0.25 in the median.
  double half_contradicts = 0.5, not_outliers = 0.25;
  /// A scale that changes along the drive is looked for where a mount seems to move, or nothing else is found
  /// and the median motion leaves more than this part of the distance unexplained (Fit), or that of one tenth
  /// of the drive does: it takes as long as all the rest. Clean drives with 1 % noise leave 0.003 to 0.02, a
  /// jump by 30 % leaves 0.1 to 0.25.
  double scale_change_misfit = 0.05;
  /// The tenth's residual must also be this many times that of the whole: with it none of 460 clean simulated
  /// drives has a scale that changes.
  double scale_change_in_tenth = 5;
  /// Correlation of the turning of both streams below which they are called unrelated, where the best answer
  /// leaves contradictory_misfit of the typical motion unexplained.
  double unrelated_correlation = 0.5;
  /// The same correlation where the best answer leaves less, but more than unrelated_misfit (at less, the
  /// streams belong together), over the eight tenths of the motions that turn most alike: outliers spoil the
  /// correlation of all. Of 79 such pairs of unrelated drives 75 are below 0.76 (the others: straight rows of
  /// tractors, 0.81 to 0.97). Of 671 clean drives none that leaves 0.12 is below 0.96, of their first five
  /// seconds and of odometries that start anew none below 0.83, of ten drives with noise of 1 to 10 degrees
  /// on every pose none below 0.87. A boat with a tenth of outliers and 4 degrees of noise has 0.80, and with
  /// a fifth of outliers is called unrelated (0.68).
  double unrelated_misfit = 0.15, unrelated_part_correlation = 0.78, unrelated_part = 0.8;
  /// Shortest drive that unrelated_part_correlation calls unrelated [s]: in a shorter one noise may be what
  /// the sensors turn by. Of 352 parts of 4 and 8 s of right drives 20 would be called unrelated, of 340 of
  /// 15 and 25 s none.
  double unrelated_least_seconds = 12;
  /// Least turning in all, of outliers cleared [rad]: where streams turn by less, the noise of odometry
  /// decides.
  double least_turning = 0.1;
  MotionSampleOptions motions;
  RobustFitOptions fit;
  ClockSearchOptions clock;
  ScaleSearchOptions scale;
  ScaleCheckOptions scale_check;
  WanderingScaleOptions wandering_scale;
  PaceCheckOptions pace;
  HeadingOptions heading;
  PlaneCheckOptions planes;
  MountCheckOptions mount;
  GoalSpreadOptions goal_spread;
  StabilityOptions stability;
  AnswerChangeOptions change;
  UndersamplingOptions undersampling;
  ClockCheckOptions clock_check;
  std::optional<GoalOptions> goal;
  /// Whose manoeuvres are advised where no goal is stated; empty: as the motions look.
  std::optional<Platform> platform;
};

}  // namespace egocal
