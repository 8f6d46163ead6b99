// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "simulated_drive.hpp"

namespace egocal::testing {

/// What a user did to right trajectories before calibrating with them.
struct Mistake {
  std::string name;
  std::string code;  ///< of the finding that names it; empty: none has to
  std::function<void(Streams&)> make;
  /// Only at speeds that vary does it leave a trace: at one speed it is another lever arm (docs/trust.md,
  /// "What no verdict can detect").
  bool of_speeds = false;
};

}  // namespace egocal::testing
