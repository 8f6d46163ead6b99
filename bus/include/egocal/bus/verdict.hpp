// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The library's diagnosis as a message, and back.
#pragma once

#include <cstddef>
#include <cstdint>

#include "egocal/bus/convert.hpp"
#include "egocal/diagnosis/verdict.hpp"
#include "egocal/uncertainty/directions.hpp"
#include "egocal/verdict_t.hpp"

namespace egocal::bus {

/// More findings than the library ever makes; a message with more is refused.
inline constexpr std::size_t max_findings = 32;

/// Which problem was judged, the answer to it, and the poses that it was judged by.
struct Judged {
  DualQuaternion T_a_b;
  std::int64_t begin_us = 0, end_us = 0;    ///< first and last pose; findings count their time from the first
  std::int64_t poses = 0;                   ///< of the slower stream, that the fit is about; 0: not measured
  Observability observability = unknown();  ///< of the answer, as_judged()

  /// The observability of an answer without an observable direction.
  static Observability unknown();
};

/// Names, session, numbers and sender are the caller's to fill in. The tenths of the fit do not travel.
verdict_t to_message(const Diagnosis& diagnosis, const Judged& judged);

/// A verdict from the wire.
struct ReceivedVerdict {
  Diagnosis diagnosis;  ///< times of findings since judged.begin_us [s]
  Judged judged;
};

/// Checks the whole message: a value means that every field may be used as it stands.
Checked<ReceivedVerdict> to_verdict(const verdict_t& message);

/// The verdict by its name; empty: another version's.
std::optional<Verdict> verdict_from_name(const std::string& name);

}  // namespace egocal::bus
