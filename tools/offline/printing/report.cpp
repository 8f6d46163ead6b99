// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/printing/report.hpp"

#include <algorithm>
#include <array>

#include "offline/common/backing_of.hpp"

namespace egocal::tools {

bool any_from_nominal(const Calibration& calibration) {
  const std::array<Backing, 6> backing = backing_of(calibration);
  return std::find(backing.begin(), backing.end(), Backing::nominal) != backing.end();
}

Pose with_positive_scalar(Pose T) {
  if (T.rotation.w() < 0) T.rotation.coeffs() *= -1;
  return T;
}

}  // namespace egocal::tools
