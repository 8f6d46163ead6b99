// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "egocal/evaluation/errors.hpp"
#include "egocal/online/algorithm1.hpp"
#include "experiments/data_set.hpp"
#include "experiments/figure.hpp"

namespace egocal::tools {

/// One frame of Fig. 6: Algorithm 1 on the motions so far.
struct OnlinePoint {
  int frame = 0;    ///< motion pairs so far
  double time = 0;  ///< since the first pose [s]
  std::optional<ExtrinsicError> error;
  /// Duality gap of the fast solution itself, over the threshold of its certificate; of the answer where
  /// there is no fast solution yet. Above 1 the global solver is asked.
  double scaled_gap = 0;
  /// The same of the answer before, on this frame's problem: what the fast solver starts from. Empty in the
  /// first frame.
  std::optional<double> scaled_gap_before;
  bool certified = false;
  bool fast_verified = false;
  bool global_used = false;
  /// Medians of repeats, so that one interruption by the scheduler draws no spike [us].
  double fast_us = 0, global_us = 0, verify_us = 0;
};

/// progress is called with the part that is done, 0 to 1.
std::vector<OnlinePoint> online_experiment(const DataSet& data, Mode mode, std::size_t frames,
                                           const OnlineOptions& options,
                                           const std::function<void(double)>& progress);

std::string csv(const std::vector<OnlinePoint>& points);
/// Fig. 6: rotation and translation error, duality gap of the fast solution, execution times.
std::vector<Panel> panels(const std::vector<OnlinePoint>& points);
/// The last frame in which the global solver was asked; 0 where it never was.
int last_global_frame(const std::vector<OnlinePoint>& points);

}  // namespace egocal::tools
