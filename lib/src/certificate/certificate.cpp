// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/certificate/certificate.hpp"

#include "certificate/proof.hpp"

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

double cost_rounding(const Matrix8d& Q, const DualQuaternion& q) {
  return detail::rounding_of<8>(detail::sizes_of<8>(Q), q.vec());
}

}  // namespace egocal
