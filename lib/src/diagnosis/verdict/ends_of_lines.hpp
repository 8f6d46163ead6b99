// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What an answer loses where a stream was interpolated before it was given.
#pragma once

#include <array>
#include <cstddef>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/streams/interpolated_stream.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct EndsOfLinesOptions {
  /// When a pose lies on a line, and which part of them in what was interpolated.
  InterpolatedStreamOptions lines;
  std::size_t least = 30;  ///< ends of lines; fewer show no answer
  std::size_t parts = 10;  ///< of the drive that are omitted in turn: their changes show what is chance
  double significant = 3;  ///< standard deviations of the change that may be chance
};

/// How far the answer may be off in each direction (x y z roll pitch yaw in sensor a's frame [m, rad]): its
/// distance from the one that the ends of the lines alone have, which were measured, less what is chance.
/// side: the stream that was interpolated. Zero where nothing can be said.
std::array<double, 6> lost_on_lines(const Evidence& evidence, Side side, double max_gap,
                                    const Answered& answered, const DiagnosisOptions& options,
                                    const EndsOfLinesOptions& lines = {});

}  // namespace egocal::detail
