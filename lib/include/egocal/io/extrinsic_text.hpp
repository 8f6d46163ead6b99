// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "egocal/geometry/pose.hpp"

namespace egocal {

/// An extrinsic with what a reader must know to use it the right way round.
struct NamedExtrinsic {
  std::string parent, child;                    ///< frames: the sensors a and b
  Pose T_parent_child;                          ///< pose of the child in the parent: p_parent = T p_child
  bool certified = false;                       ///< globally optimal, proven
  long long pairs = 0;                          ///< motion pairs behind it
  std::optional<std::array<double, 6>> stddev;  ///< x y z [m] roll pitch yaw [rad] in the parent's frame
};

enum class ExtrinsicFormat {
  yaml,    ///< plain: translation, quaternion, matrix, standard deviations
  ros,     ///< a static_transform_publisher command line
  urdf,    ///< a fixed joint
  kalibr,  ///< a camera chain's T_cam_imu with the parent as imu and the child as camera
};
std::string_view name(ExtrinsicFormat format);
std::optional<ExtrinsicFormat> extrinsic_format_from_name(std::string_view name);

/// The whole text of a file; every format names parent, child, direction and quaternion order. Numbers read
/// back as exactly the same doubles. Throws Error where a value is not finite: nobody shall mount a sensor at
/// NaN.
std::string extrinsic_text(const NamedExtrinsic& extrinsic, ExtrinsicFormat format);

}  // namespace egocal
