// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/hint.hpp"

#include <cstdio>

namespace egocal::detail {

namespace {

std::string text_of(const Eigen::Vector3d& v) {
  char text[64];
  const Eigen::Vector3d shown = ((100 * v).array().round() / 100 + 0.0).matrix();  // no "-0.00"
  std::snprintf(text, sizeof text, "(%.2f, %.2f, %.2f)", shown.x(), shown.y(), shown.z());
  return text;
}

}  // namespace

std::string spatial_hint(int hidden_translations, bool rotation_hidden,
                         const Eigen::Vector3d& hidden_direction) {
  if (hidden_translations >= 2 && rotation_hidden) return "still needed: motion with turns";
  if (hidden_translations >= 2) return "still needed: turns";
  if (rotation_hidden) return "still needed: turns, or motion in another direction";
  if (hidden_translations == 1)
    return "still needed: rotation about an axis across " + text_of(hidden_direction) +
           " of a (on the ground: ramps, bumps, banked curves)";
  return "";
}

std::string planar_hint(bool translation_hidden, bool yaw_hidden, int hidden) {
  if (hidden == 0) return "";
  // on circles of one radius the sensor may be turned on its circle as well as moved along it
  if (translation_hidden && yaw_hidden && hidden == 1)
    return "still needed: curves of other radii, or a straight stretch";
  return translation_hidden ? "still needed: turns" : "still needed: motion";
}

}  // namespace egocal::detail
