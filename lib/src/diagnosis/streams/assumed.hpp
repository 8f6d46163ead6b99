// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/diagnosis/verdict.hpp"

namespace egocal::detail {

/// What both streams state without having measured it.
struct Assumed {
  Finding finding;  ///< certain
  std::array<bool, 6>
      directions{};  ///< x y z roll pitch yaw, in the frame of a: the motions agree about them
};

}  // namespace egocal::detail
