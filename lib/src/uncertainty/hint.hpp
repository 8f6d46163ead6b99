// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

namespace egocal::detail {

/// Which motion would help, from the number of translation directions that are not seen, one of them (unit,
/// frame of sensor a), and whether a rotation is not seen. Empty where nothing is missing.
std::string spatial_hint(int hidden_translations, bool rotation_hidden,
                         const Eigen::Vector3d& hidden_direction);

/// The same in the plane: whether a translation is not seen, and whether the yaw is not, in `hidden`
/// directions.
std::string planar_hint(bool translation_hidden, bool yaw_hidden, int hidden);

}  // namespace egocal::detail
