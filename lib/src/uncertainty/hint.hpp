// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

namespace egocal::detail {

/// The motion that would help: from the number of hidden translation directions, one of them (unit, frame of
/// sensor a), and whether a rotation is hidden. Empty: nothing is hidden.
std::string spatial_hint(int hidden_translations, bool rotation_hidden,
                         const Eigen::Vector3d& hidden_direction);

/// The same in the plane: whether a translation or the yaw is hidden, in `hidden` directions.
std::string planar_hint(bool translation_hidden, bool yaw_hidden, int hidden);

}  // namespace egocal::detail
