// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/shrink.hpp"

namespace egocal::simulation {

Plan shrink(const Plan& plan, char check, int most_lives) {
  Plan best = plan;
  for (bool again = true; again && most_lives > 0;) {
    again = false;
    for (Simpler& attempt : simpler(best)) {
      if (most_lives-- <= 0) break;
      const Outcome outcome = live(attempt.plan);
      if (!outcome.violation || outcome.violation->check != check) continue;
      best = std::move(attempt.plan);
      again = true;
      break;
    }
  }
  return best;
}

}  // namespace egocal::simulation
