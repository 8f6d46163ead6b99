// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/diagnosis/as_judged.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace egocal {

Observability as_judged(Observability stated, const Diagnosis& diagnosis) {
  for (std::size_t i = 0; i < diagnosis.timing_stddev.size(); ++i)
    if (diagnosis.timing_stddev[i] > 0)  // else not a bit is changed
      stated.stddev[i] = std::hypot(stated.stddev[i], diagnosis.timing_stddev[i]);
  for (std::size_t i = 0; i < diagnosis.assumed.size(); ++i)
    if (diagnosis.assumed[i]) {
      stated.observable[i] = false;
      stated.stddev[i] = std::numeric_limits<double>::infinity();
      stated.hint.clear();  // no motion would help
    }
  return stated;
}

}  // namespace egocal
