// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/common/backing_of.hpp"

#include "egocal/bus/backing.hpp"

namespace egocal::tools {

std::array<Backing, 6> backing_of(const Calibration& calibration) {
  return bus::backing_of(calibration.observability.observable, calibration.problem);
}

}  // namespace egocal::tools
