// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/pairing/outcome.hpp"

namespace egocal {

std::string_view to_string(Rejection reason) {
  switch (reason) {
    case Rejection::not_finite:
      return "not finite";
    case Rejection::out_of_order:
      return "out of order";
    case Rejection::no_partner:
      return "no partner";
    case Rejection::gap:
      return "gap";
    case Rejection::frozen:
      return "frozen";
    case Rejection::screw_congruence:
      return "screw congruence";
    case Rejection::too_much_rotation:
      return "too much rotation";
    case Rejection::count_:
      break;
  }
  return "unknown";
}

}  // namespace egocal
