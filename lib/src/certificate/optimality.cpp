// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/certificate/certificate.hpp"

namespace egocal {

std::string_view to_string(Optimality optimality) {
  switch (optimality) {
    case Optimality::certified:
      return "certified";
    case Optimality::not_optimal:
      return "not optimal";
    case Optimality::undecided:
      break;
  }
  return "undecided";
}

}  // namespace egocal
