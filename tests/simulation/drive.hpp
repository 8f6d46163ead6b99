// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "egocal/bus/rig.hpp"
#include "egocal/geometry/dual_quaternion.hpp"
#include "simulation/plan.hpp"

namespace egocal::simulation {

struct Message {
  std::int64_t time_us = 0;  ///< of the measurement; that of the first one is HostClock::start_of_all_us
  std::size_t channel = 0;   ///< sensor of the rig
  std::vector<std::byte> bytes;
};

/// What the sensors of a life measure, encoded once.
struct Drive {
  bus::Rig rig;
  std::vector<Message> messages;  ///< of all sensors, by time
  std::vector<std::byte> log;     ///< the same as an LCM log
  /// T_a_b of the rig's pairs; two where the mount moves.
  std::vector<std::vector<DualQuaternion>> truth;
};
Drive make_drive(const Plan& plan);

}  // namespace egocal::simulation
