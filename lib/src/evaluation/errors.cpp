// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/evaluation/errors.hpp"

#include <cmath>

namespace egocal {

ExtrinsicError extrinsic_error(const DualQuaternion& truth, const DualQuaternion& estimate) {
  const DualQuaternion q = canonical_sign(conjugate(truth) * estimate);
  // atan2 for the arccos of (32a): exact for small errors
  return {2 * quaternion_product(q.dual, quaternion_conjugate(q.real)).norm(),
          2 * std::atan2(q.real.tail<3>().norm(), q.real[0])};
}

}  // namespace egocal
