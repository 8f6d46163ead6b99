// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/deviation.hpp"

#include "experiments/figure.hpp"

namespace egocal::tools {

Deviations deviations(const std::vector<Eigen::Vector3d>& errors) {
  Deviations result;
  if (errors.empty()) return result;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> component;
    component.reserve(errors.size());
    for (const Eigen::Vector3d& error : errors) component.push_back(error[axis]);
    result.common[axis] = median(component);
  }
  for (const Eigen::Vector3d& error : errors) result.lengths.push_back((error - result.common).norm());
  return result;
}

}  // namespace egocal::tools
