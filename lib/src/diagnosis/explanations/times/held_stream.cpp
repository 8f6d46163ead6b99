// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/times/held_stream.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "diagnosis/explanations/measured_part.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"
#include "egocal/statistics/median.hpp"
#include "pairing/offset/pose_at.hpp"

namespace egocal::detail {

namespace {

Finding worded(const Held& found, char which) {
  const char* const half = found.positions ? "positions" : "rotations";
  const char* const other = found.positions ? "rotations" : "positions";
  Finding finding;
  finding.code = std::string("held_") + which;
  finding.certain = true;
  finding.value = found.rate;
  say(finding,
      format(
          "The %s of %s repeat while its %s go on: about %.1f are new each second, the others are held, and "
          "late.",
          half, mark(which), other, found.rate),
      format("Give the poses of %s whose %s are new, at the times of these.", mark(which), half));
  return finding;
}

/// Clock and scale under which the streams belong together but for what is held.
struct Corrected {
  ClockModel clock;
  double scale = 1;  ///< of the lengths of b
};

/// Clock and scale by what was found for certain.
Corrected corrected_by(const std::vector<Finding>& findings, const ClockModel& given) {
  Corrected result{given, 1};
  for (const Finding& one : findings) {
    if (!one.certain || !one.value) continue;
    if (one.code == "clock_offset") result.clock = {*one.value, 0, 0};
    if (one.code == "scale" || one.code == "units") result.scale = *one.value;
  }
  return result;
}

/// The answer of the rows with new values, from motions as long as those that are compared elsewhere. Empty:
/// there are too few.
std::optional<Pose> fitted_to_new(const Held& found, Side side, const Evidence& evidence,
                                  const Corrected& corrected, double max_gap,
                                  const DiagnosisOptions& diagnosis) {
  const Trajectory& own = side == Side::a ? evidence.streams.a : evidence.streams.b;
  Trajectory measured;
  for (const std::size_t i : found.fresh) measured.push_back(own[i]);
  const Motions motions =
      scaled(motions_of_part(measured, side, evidence, corrected.clock, max_gap, diagnosis), corrected.scale);
  if (motions.all.size() < diagnosis.motions.least) return std::nullopt;
  return to_pose(robust_fit(motions, diagnosis.fit).T);
}

/// What an extrinsic leaves of one half, in the median [m or rad].
double median_left(const std::vector<MotionPair>& pairs, const Pose& T, double scale_b, bool positions) {
  std::vector<double> left;
  for (const Motion& motion : scaled(motions_of(pairs), scale_b).all) {
    const Residual residual = residual_at(motion, T);
    left.push_back(positions ? residual.translation : residual.rotation);
  }
  return left.empty() ? 0 : median(std::move(left));
}

/// Whether the sensor of this side moves on while its values repeat.
bool moves_on(const Held& found, Side side, const Evidence& evidence, const Corrected& corrected,
              double max_gap, const Pose& T, const HeldStreamOptions& options) {
  const bool of_a = side == Side::a;
  const Trajectory &own = of_a ? evidence.streams.a : evidence.streams.b,
                   &other = of_a ? evidence.streams.b : evidence.streams.a;
  const double shift_us = (of_a ? -1e6 : 1e6) * corrected.clock.offset, gap_us = 1e6 * max_gap;
  std::vector<MotionPair> between, meanwhile;
  const std::size_t each = std::max<std::size_t>(1, found.repeating.size() / options.most);
  std::size_t from = 0;
  for (std::size_t k = 0; k < found.repeating.size(); k += each) {
    const HeldRows& rows = found.repeating[k];
    const auto other_at = [&](std::size_t i) {
      return pose_at(other, own[i].time_us, shift_us, gap_us, from);
    };
    const auto begin = other_at(rows.fresh), last = other_at(rows.last), next = other_at(rows.next);
    if (!begin || !last || !next) continue;
    const auto motion = [&](std::size_t to, const DualQuaternion& other_to) {
      const DualQuaternion of_own = canonical_sign(conjugate(own[rows.fresh].pose) * own[to].pose),
                           of_other = canonical_sign(conjugate(*begin) * other_to);
      return MotionPair{of_a ? of_own : of_other, of_a ? of_other : of_own, own[rows.fresh].time_us,
                        own[to].time_us};
    };
    between.push_back(motion(rows.next, *next));
    meanwhile.push_back(motion(rows.last, *last));
  }
  if (meanwhile.size() < options.rows.least) return false;
  return median_left(meanwhile, T, corrected.scale, found.positions) >
         options.moved * median_left(between, T, corrected.scale, found.positions);
}

struct HeldHalf {
  Held rows;
  Pose T;
};

/// The half that is held, with the streams as given, or else under what was found.
std::optional<HeldHalf> held_half(Side side, const Evidence& evidence, const Corrected& corrected,
                                  double max_gap, const DiagnosisOptions& diagnosis,
                                  const HeldStreamOptions& options) {
  std::optional<Held> found =
      repeating_half(side == Side::a ? evidence.streams.a : evidence.streams.b, options.rows);
  if (!found) return std::nullopt;
  for (const Corrected& how : {Corrected{evidence.clock, 1}, corrected}) {
    const std::optional<Pose> T = fitted_to_new(*found, side, evidence, how, max_gap, diagnosis);
    if (T && moves_on(*found, side, evidence, how, max_gap, *T, options))
      return HeldHalf{*std::move(found), *T};
  }
  return std::nullopt;
}

}  // namespace

std::vector<Finding> held_streams(const Evidence& evidence, double max_gap, const DiagnosisOptions& diagnosis,
                                  const std::vector<Finding>& beside, const HeldStreamOptions& options) {
  const Corrected corrected = corrected_by(beside, evidence.clock);
  std::vector<Finding> findings;
  for (const Side side : {Side::a, Side::b}) {
    const std::optional<HeldHalf> found = held_half(side, evidence, corrected, max_gap, diagnosis, options);
    if (!found) continue;
    findings.push_back(worded(found->rows, side == Side::a ? 'a' : 'b'));
    findings.back().T_a_b = found->T;
  }
  return findings;
}

void name_held_streams(const Evidence& evidence, double max_gap, const DiagnosisOptions& diagnosis,
                       std::vector<Finding>& findings) {
  const std::vector<Finding> held = held_streams(evidence, max_gap, diagnosis, findings);
  for (const Finding& one : held) {
    const double period = 1 / one.value.value();
    std::erase_if(findings, [&](const Finding& other) {
      const bool within = std::abs(other.value.value_or(0)) < period;
      if (other.code == "inverted_both") return !other.certain;
      // held values of one stream are those of the other one early
      return within && (other.code == "clock_offset" || other.code.starts_with("late_positions_"));
    });
  }
  findings.insert(findings.begin(), held.begin(), held.end());
}

}  // namespace egocal::detail
