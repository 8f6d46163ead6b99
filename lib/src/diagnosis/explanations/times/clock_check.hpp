// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Clocks that differ by a few milliseconds.
#pragma once

#include <optional>
#include <string>

#include "diagnosis/motions/answer_change.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/time_offset.hpp"

namespace egocal::detail {

/// The offset of the middle part that its turning shows: all of small_clock_offset() that needs no answer,
/// and most of its time.
std::optional<TimeOffset> offset_by_turning(const MiddlePart& part, const PairingOptions& pairing,
                                            const ClockCheckOptions& options);

/// Finding clock_offset, certain, where the offset differs from zero by several of its own standard
/// deviations and moves the answer by more than the answer states to be uncertain. Roll, pitch and yaw of a
/// walking machine have fixed phases: late by 2 ms, its axes seem turned by half a degree, in every part of
/// the drive alike. The streams are paired again where that is likely. instants: of `part`; found: its
/// offset_by_turning().
std::optional<Finding> small_clock_offset(const Trajectory& a, const Trajectory& b,
                                          const PairingOptions& pairing, const MiddlePart& part,
                                          const Instants& instants, const std::optional<TimeOffset>& found,
                                          const Answered& answered, const DiagnosisOptions& options);

/// Finding clock_offset, uncertain: another time offset fits as well as the one that was estimated, as the
/// motion repeats. T_a_b: the answer with that one. Needs offset.rival.
Finding rival_clock_offset(const TimeOffset& offset, const DualQuaternion& T_a_b);

/// The rival in words, where its answer is off by more than the tolerance; empty: it is not.
std::string rival_in_words(const Finding& rival, const Pose& T_a_b, const Observability& observability,
                           const DiagnosisOptions& options);

}  // namespace egocal::detail
