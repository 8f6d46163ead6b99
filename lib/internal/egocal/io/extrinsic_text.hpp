// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/geometry/pose.hpp"

namespace egocal {

/// A sensor whose lengths have another unit than those of the other one, which is that of the translation.
struct NamedScale {
  std::string sensor;
  double value = 1;        ///< its lengths, multiplied by this, are those of the other sensor
  double stddev = 0;       ///< infinite: unknown
  bool certified = false;  ///< no other scale fits better, proven
  bool metres = true;      ///< false: whether the other sensor measures metres is not known
  bool changes = false;    ///< along the drive: the value is its mean
};

/// What the number of a direction rests on.
enum class Backing {
  motions,  ///< the motions show it
  nominal,  ///< they do not: it is the nominal value's
  planes,   ///< the ground planes give it (planar mode)
  none,     ///< they do not, and nothing else gives it: the number means nothing
};

/// An extrinsic with what a reader must know to use it the right way round.
struct NamedExtrinsic {
  std::string parent, child;                    ///< frames: the sensors a and b
  Pose T_parent_child;                          ///< pose of the child in the parent: p_parent = T p_child
  bool certified = false;                       ///< globally optimal, proven
  long long pairs = 0;                          ///< motion pairs behind it
  std::optional<std::array<double, 6>> stddev;  ///< x y z [m] roll pitch yaw [rad] in the parent's frame
  bool usable = true;     ///< false: optimal, but the motions contradict each other; every format states it
  std::string verdict{};  ///< good, incomplete, doubtful, contradictory; empty: it was not judged
  std::optional<NamedScale> scale{};  ///< that was found together with it; every format states it
  std::string reason{};               ///< of the verdict, one sentence; every format states both
  /// What the numbers of x y z roll pitch yaw rest on; every format states those that do not rest on the
  /// motions. Empty: this is not known, and directions without a finite standard deviation count as
  /// Backing::none.
  std::optional<std::array<Backing, 6>> backing{};
  std::string backing_frame{};  ///< the frame that these directions are of; empty: the parent's
};

/// The directions that the motions do not show, and what their numbers are: "NOT OBSERVABLE, not a
/// measurement: z". Also those of the ground planes. Empty: there is none of either.
std::string not_shown_in_words(const NamedExtrinsic& extrinsic);

enum class ExtrinsicFormat {
  yaml,        ///< plain: translation, quaternion, matrix, standard deviations
  json,        ///< the same with a name for every number, and the inverse
  ros,         ///< a static_transform_publisher command line
  ros_launch,  ///< a ROS 2 launch file (XML) with a static_transform_publisher
  urdf,        ///< a fixed joint
  kalibr,      ///< a camera chain's T_cam_imu with the parent as imu and the child as camera
  autoware,  ///< a sensor kit's sensors_calibration.yaml: x y z roll pitch yaw of the child below its parent
  lio_sam,   ///< extrinsicTrans, extrinsicRot, extrinsicRPY with the parent as lidar and the child as imu
  opencv,    ///< FileStorage with R and T as stereoRectify takes them: points of the parent to the child
  matrix,    ///< 4 x 4 numbers, for numpy.loadtxt and the like
};
std::string_view to_string(ExtrinsicFormat format);
std::optional<ExtrinsicFormat> extrinsic_format_from_name(std::string_view name);
/// All of them, in the order above.
std::vector<std::string> extrinsic_format_names();

/// Whether every format can hold a frame of this name as it is: up to 100 letters, digits and _ - . / of
/// ASCII, no - first. In other names each other character is written as _.
bool is_frame_name(const std::string& name);

/// The whole text of a file; every format names parent, child, direction and quaternion order. Numbers read
/// back as exactly the same doubles. Throws Error where a value is not finite: a sensor mounted at NaN would
/// be worse than none; and where parent and child are written alike.
std::string extrinsic_text(const NamedExtrinsic& extrinsic, ExtrinsicFormat format);

}  // namespace egocal
