// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/report.hpp"

#include "offline/named_extrinsic.hpp"

namespace egocal::tools {

bool from_nominal(const Calibration& calibration, std::size_t direction) {
  return backing_of(calibration)[direction] == Backing::nominal;
}

bool any_from_nominal(const Calibration& calibration) {
  for (std::size_t i = 0; i < 6; ++i)
    if (from_nominal(calibration, i)) return true;
  return false;
}

Pose with_positive_scalar(Pose T) {
  if (T.rotation.w() < 0) T.rotation.coeffs() *= -1;
  return T;
}

}  // namespace egocal::tools
