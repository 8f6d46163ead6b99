// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sdpa_rival.hpp"

#include <sdpa_call.h>

namespace egocal::bench {

Multipliers sdpa(const Matrix8d& Q) {
  // min c . x subject to F1 x1 + F2 x2 - F0 >= 0, with x = lambda and indices from one
  SDPA problem;
  problem.setDisplay(nullptr);
  problem.setParameterType(SDPA::PARAMETER_DEFAULT);
  problem.setNumThreads(1);
  problem.inputConstraintNumber(2);
  problem.inputBlockNumber(1);
  problem.inputBlockSize(1, 8);
  problem.inputBlockType(1, SDPA::SDP);
  problem.initializeUpperTriangleSpace();
  problem.inputCVec(1, -1);
  problem.inputCVec(2, 0);
  for (int i = 0; i < 8; ++i)
    for (int j = i; j < 8; ++j) problem.inputElement(0, 1, i + 1, j + 1, -Q(i, j));
  for (int i = 1; i <= 4; ++i) {
    problem.inputElement(1, 1, i, i, -1);
    problem.inputElement(2, 1, i, i + 4, 1);
  }
  problem.initializeUpperTriangle();
  problem.initializeSolve();
  problem.solve();
  const Multipliers lambda{problem.getResultXVec()[0], problem.getResultXVec()[1]};
  problem.terminate();
  return lambda;
}

}  // namespace egocal::bench
