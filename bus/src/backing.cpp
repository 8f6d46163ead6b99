// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/backing.hpp"

namespace egocal::bus {

std::array<Backing, 6> backing_of(const Observability& observability, bool planar, bool has_nominal) {
  const Backing instead = planar ? (observability.hint.empty() ? Backing::planes : Backing::none)
                                 : (has_nominal ? Backing::nominal : Backing::none);
  std::array<Backing, 6> backing{};
  for (std::size_t i = 0; i < backing.size(); ++i)
    if (!observability.observable[i]) backing[i] = instead;
  return backing;
}

}  // namespace egocal::bus
