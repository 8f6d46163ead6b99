// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/io/poses_as_given.hpp"

namespace egocal::tools {

/// The poses of FILE or FILE:TOPIC as the file has them, of an LCM log as well.
struct PosesAsGiven {
  PosesOfFile list;
  bool has_scale = true;
  std::vector<std::string> notes;    ///< each with the name of the file
  std::vector<std::string> repairs;  ///< what putting them in order by time does, likewise
};

/// Throws Error as read_any_trajectory() does.
PosesAsGiven read_as_given(const std::string& name, const ReadOptions& options);

}  // namespace egocal::tools
