// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/bus/rig.hpp"

namespace egocal::services {

/// Whose state a file holds. It is useless to another process, rig or version of the mathematics.
struct StateIdentity {
  std::string process;  ///< "egocal-pairing"; the state of another process is not touched
  std::string text;     ///< everything else, one line each; a state with other lines is refused
};

/// The identity of a state of this process, with this layout of its fields, for this rig.
StateIdentity state_identity(const std::string& process, int layout, const bus::Rig& rig);

}  // namespace egocal::services
