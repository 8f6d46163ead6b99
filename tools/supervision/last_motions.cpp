// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/last_motions.hpp"

namespace egocal::tools {

void LastMotions::hear(const problem_t& problem) {
  const PairName pair{problem.sensor_a, problem.sensor_b};
  if (newest_.size() >= most_pairs && !newest_.contains(pair)) return;
  const Number number{problem.session, problem.seq};
  const auto before = newest_.find(pair);
  if (before != newest_.end() && before->second == number)
    last_.insert(pair);
  else
    last_.erase(pair);
  newest_[pair] = number;
}

}  // namespace egocal::tools
