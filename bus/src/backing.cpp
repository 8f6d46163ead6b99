// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/backing.hpp"

#include <cmath>

#include "egocal/uncertainty/observability.hpp"

namespace egocal::bus {

namespace {

/// Whether the ground planes give this direction, or a part of it.
bool of_planes(const GroundPlane& plane_a, std::size_t direction) {
  const double normal = std::abs(plane_a.normal[static_cast<int>(direction % 3)]);
  const double leak = ObservabilityOptions().leak;
  return direction < 3 ? normal > leak : 1 - normal > leak;
}

}  // namespace

std::array<Backing, 6> backing_of(const std::array<bool, 6>& observable, const Problem& problem) {
  std::array<Backing, 6> backing{};
  for (std::size_t i = 0; i < backing.size(); ++i) {
    if (observable[i]) continue;
    if (problem.mode == Mode::planar)
      backing[i] = of_planes(problem.plane_a, i) ? Backing::planes : Backing::none;
    else
      backing[i] = problem.prior ? Backing::nominal : Backing::none;
  }
  return backing;
}

std::array<Backing, 6> backing_of(const CheckedAnswer& checked, const std::string& method, bool has_nominal) {
  const std::array<bool, 6>& observable = checked.answer.observability.observable;
  if (checked.problem) return backing_of(observable, *checked.problem);
  Problem problem;
  if (method == "planar") problem.mode = Mode::planar;
  if (has_nominal) problem.prior.emplace();
  return backing_of(observable, problem);
}

}  // namespace egocal::bus
