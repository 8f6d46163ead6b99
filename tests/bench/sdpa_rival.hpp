// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/problem/cost.hpp"

namespace egocal::bench {

/// (22) by SDPA's callable library at its default tolerance, from building its problem to the multipliers.
Multipliers sdpa(const Matrix8d& Q);

/// SDPA prints remarks that it cannot be asked to keep to itself: standard output goes nowhere while this
/// lives.
class Silence {
 public:
  Silence();
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int kept_;
};

}  // namespace egocal::bench
