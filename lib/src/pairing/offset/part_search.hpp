// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "egocal/pairing/time_offset.hpp"
#include "pairing/offset/correlation.hpp"
#include "pairing/offset/schedule.hpp"

namespace egocal::detail {

/// Finds the offset in each part of a long drive, outwards from the part in which both streams agree best. A
/// drifting clock smears the correlation of the whole drive.
class PartSearch {
 public:
  /// lag: in the middle of b where the clock drifts [grid steps]; rate: of the drift [s/s], 0: none is shown.
  using Done = std::function<void(double lag, double rate)>;

  /// a, b: angles on a grid of step_us. The work is added to the schedule; all references must outlive the
  /// object.
  PartSearch(const Series& a, const Series& b, std::int64_t step_us, const TimeOffsetOptions& options,
             Schedule& schedule, Done done);

  /// lag: the best one of the whole drive.
  void begin(std::ptrdiff_t lag);

  double middle() const;  ///< of all parts [s since the begin of b]

 private:
  std::size_t points(double seconds) const;
  Correlation best_in_part(std::size_t i, std::ptrdiff_t centre, std::size_t reach) const;
  void follow_outwards();
  void fit_line();

  const Series& a_;
  const Series& b_;
  const std::int64_t step_us_;
  const TimeOffsetOptions& options_;
  Schedule& schedule_;
  Done done_;
  std::ptrdiff_t lag_ = 0;
  std::vector<Correlation> parts_;
};

}  // namespace egocal::detail
