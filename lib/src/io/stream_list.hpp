// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/io/recording.hpp"

namespace egocal::detail {

/// "topics with poses: /odom (nav_msgs/Odometry, 517), /tf:odom/base_link (12)", or that there are none and
/// what there is instead. At most some 700 characters.
std::string topics_in_words(const std::vector<RecordedStream>& streams);

/// Why an existing topic has no poses: "is of type nav_msgs/Path, whose ...", "holds 2 transforms that move:
/// ...". Empty for any other name.
std::string why_no_poses(const std::vector<RecordedStream>& streams, const std::string& name);

}  // namespace egocal::detail
