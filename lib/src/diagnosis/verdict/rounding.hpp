// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the digits that the poses were written with leave unknown. Poses of a vehicle that hardly rolls are
// rounded alike for minutes: that error is the same in all parts of the drive, so the scatter between them,
// from which standard deviations are made, does not contain it.
#pragma once

#include <array>
#include <cstddef>

#include "diagnosis/motions/answer_change.hpp"
#include "diagnosis/streams/written_digits.hpp"

namespace egocal::detail {

struct RoundingOptions {
  WrittenDigitsOptions digits;
  std::size_t motions = 1000;  ///< of each length that are looked at: 7 ms for each of `coarser` roundings
  /// Rounding of less than this part of the usual motion moves no answer by what it states: of 4 decimals of
  /// a quaternion (0.003 deg) in motions of 3 degrees, of a millimetre in a metre.
  double least = 1e-3;
  /// Size of the steps that the poses are rounded to once more, over the step that they were written with:
  /// odd, as multiples of a step are then never in the middle between two coarser ones. 3 is the least such
  /// number, so the nearest to the rounding that was.
  int coarser = 3;
};

/// One standard deviation of the answer by the rounding of both streams, as far as parts of the drive share
/// it (x y z roll pitch yaw in sensor a's frame [m, rad]); 0 where nothing was rounded. It is measured: the
/// poses are rounded once more, to steps that are `coarser` times as large. stride: of the answer, in
/// instants. motions: those of the answer.
std::array<double, 6> rounding_stddev(const MiddlePart& part, const Instants& instants, int stride,
                                      const Motions& motions, const DualQuaternion& T_a_b, double time_offset,
                                      double max_gap, const DiagnosisOptions& options,
                                      const RoundingOptions& tuning = {});

}  // namespace egocal::detail
