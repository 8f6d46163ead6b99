// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/extrinsic/words.hpp"

namespace egocal::detail {

namespace {

template <class Vector>
std::string matrix(const char* name, int rows, int columns, const Vector& values) {
  return std::string(name) + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
         "\n   cols: " + std::to_string(columns) + "\n   dt: d\n   data: [ " + joined(values, ", ") + " ]\n";
}

}  // namespace

std::string opencv_text(const ExtrinsicWords& words) {
  const Pose inverted = inverse(words.T);
  return "%YAML:1.0\n---\n# R and T as stereoRectify and solvePnP take them: p_" + words.b + " = R * p_" +
         words.a + " + T, the inverse of the pose of " + words.b + " in " + words.a + ".\n# " +
         words.lengths + "; R as quaternion w x y z: [" + joined(wxyz(inverted.rotation), ", ") + "]\n# " +
         words.verdict_of_inverse + "\n" + matrix("R", 3, 3, rotation_rows(inverted.rotation)) +
         matrix("T", 3, 1, inverted.translation);
}

}  // namespace egocal::detail
