// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "answers/answers.hpp"
#include "egocal/bus/rig.hpp"
#include "supervision/log_extent.hpp"

namespace egocal::tools {

/// What was calibrated while somebody watched.
struct Outcome {
  bool answered = false;  ///< any solver, for any pair
  /// Whether the answer of some pair should not be used: its motions contradict each other, it misses the
  /// goal, it lacks the end of the log, or it has moved since the last verdict.
  bool unusable = false;
  /// The verdict, proof and transform of each pair, or that it has no answer. Where a bus was watched and
  /// nothing was answered on it: why, in one line, or empty.
  std::string text;
};

struct OutcomeOptions {
  /// Streams do not begin and end together, and pairing waits for a neighbour to interpolate: less than this
  /// is not missed at either end of a log [s]. Study: of 96 pairs of streams that were recorded together
  /// (../shared/data) the begins and ends of 93 are less than 1 s apart, of three up to 4 s.
  double least_missing = 1;
  /// The end of a log is reported as missing in an answer where the pair's last motion is farther from it
  /// [s], and so is a hole in its middle that is longer. As BusNewsOptions::standing.
  double standing = 5;
  /// A sensor is reported as silent if it sends nothing for longer than `standing`, and for longer than this
  /// many times the mean time between two of its messages. So slow sensors are not silent.
  double silent_periods = 10;
  /// What is missing in many short pieces is reported from this part of the drive on: single messages may be
  /// lost or late.
  double least_part = 0.1;
};

/// How far pairing has read each channel, by its acknowledgements [us, the sensor's time].
using ReadUntil = std::map<std::string, std::int64_t>;

/// The outcome at the end of a log. An answer without the log's end is not one of the log, whatever its
/// verdict: it is unusable. An answer that begins late or has a hole in its middle is usable, and what is
/// missing is named, as is damage of the log.
Outcome outcome_of(const bus::Rig& rig, const Answers& answers, const LogExtent& extent,
                   const ReadUntil& read_until, const OutcomeOptions& options = {});

}  // namespace egocal::tools
