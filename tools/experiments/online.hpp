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

namespace egocal::tools {

/// One frame of Fig. 6: Algorithm 1 on the motions so far.
struct OnlinePoint {
  int frame = 0;    ///< motion pairs so far
  double time = 0;  ///< since the first pose [s]
  std::optional<ExtrinsicError> error;
  double scaled_gap = 0;
  bool certified = false;
  bool fast_verified = false;
  bool global_used = false;
  double microseconds = 0;  ///< of this step: accumulate, solve, verify
};

/// progress is called with the part that is done, 0 to 1.
std::vector<OnlinePoint> online_experiment(const DataSet& data, Mode mode, std::size_t frames,
                                           const OnlineOptions& options,
                                           const std::function<void(double)>& progress);

std::string csv(const std::vector<OnlinePoint>& points);
std::string plot(const std::vector<OnlinePoint>& points, const std::string& csv_file,
                 const std::string& png_file);

}  // namespace egocal::tools
