// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/backing.hpp"

#include <cstddef>

#include "egocal/uncertainty/plane_directions.hpp"

namespace egocal::bus {

std::array<Backing, 6> backing_of(const std::array<bool, 6>& observable, const Problem& problem) {
  std::array<Backing, 6> backing{};
  for (std::size_t i = 0; i < backing.size(); ++i) {
    if (observable[i]) continue;
    if (problem.mode == Mode::planar)
      backing[i] = in_plane(problem.plane_a, i) ? Backing::none : Backing::planes;
    else
      backing[i] = problem.prior ? Backing::nominal : Backing::none;
  }
  return backing;
}

std::array<Backing, 6> backing_of(const CheckedAnswer& checked, const std::string& method, bool has_nominal,
                                  const Diagnosis* diagnosis) {
  const std::array<bool, 6>& observable = checked.answer.observability.observable;
  std::array<Backing, 6> backing{};
  if (checked.problem) {
    backing = backing_of(observable, *checked.problem);
  } else {
    Problem problem;
    if (method == "planar") problem.mode = Mode::planar;
    if (has_nominal) problem.prior.emplace();
    backing = backing_of(observable, problem);
  }
  // no nominal value was used of what the statistics seem to show
  for (std::size_t i = 0; diagnosis && i < backing.size(); ++i)
    if (observable[i] && diagnosis->assumed[i]) backing[i] = Backing::none;
  return backing;
}

}  // namespace egocal::bus
