// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/common/backing_of.hpp"

#include <algorithm>

#include "egocal/bus/backing.hpp"

namespace egocal::tools {

std::array<Backing, 6> backing_of(const Calibration& calibration) {
  std::array<Backing, 6> backing = bus::backing_of(calibration.observability.observable, calibration.problem);
  // the answer has the directions that both streams assume, no nominal ones
  const auto assumed = [](const Finding& finding) {
    return finding.code == "flat_both" || finding.code == "missing_both";
  };
  if (std::any_of(calibration.findings.begin(), calibration.findings.end(), assumed))
    for (std::size_t i = 3; i < backing.size(); ++i)
      if (backing[i] == Backing::nominal) backing[i] = Backing::none;
  return backing;
}

std::string not_shown_in_words(const Calibration& calibration) {
  NamedExtrinsic extrinsic;
  extrinsic.backing = backing_of(calibration);
  return egocal::not_shown_in_words(extrinsic);
}

}  // namespace egocal::tools
