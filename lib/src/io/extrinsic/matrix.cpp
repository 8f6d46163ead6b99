// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/extrinsic/words.hpp"

namespace egocal::detail {

std::string matrix_text(const ExtrinsicWords& words) {
  const Eigen::Matrix<double, 9, 1> R = rotation_rows(words.T.rotation);
  std::string text = "# 4 x 4, " + words.direction + ", " + words.lengths +
                     "; quaternion w x y z: " + joined(wxyz(words.T.rotation), " ") + "\n# " + words.verdict +
                     "\n";
  for (int i = 0; i < 3; ++i)
    text += joined(R.segment<3>(3 * i), " ") + " " + exact(words.T.translation[i]) + "\n";
  return text + "0 0 0 1\n";
}

}  // namespace egocal::detail
