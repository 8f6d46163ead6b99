// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "egocal/geometry/dual_quaternion.hpp"

namespace egocal::bench {

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Extended;  ///< 113 bits of mantissa
#else
typedef long double Extended;
#endif

/// J(q), exact for all purposes: q is first projected on the constraints in extended precision, where the
/// rounding of a double dual quaternion would matter.
Extended extended_cost(const Matrix8d& Q, const DualQuaternion& q);

struct Reference {
  Extended cost = 0;
  DualQuaternion q;  ///< rounded to double
  bool proven =
      false;  ///< Z(lambda) >= 0 in extended precision with lambda_1 within 1e-22 trace(Q) of the cost
};

/// The minimum of (18), from the best of several starts by Newton steps on the KKT system in extended
/// precision, and proven by a factorisation of Z(lambda) (21). Q is taken as it is given.
Reference reference(const Matrix8d& Q, const std::vector<DualQuaternion>& starts);

/// The minimum of (18) under (26).
Reference planar_reference(const Matrix8d& Q_planar);

}  // namespace egocal::bench
