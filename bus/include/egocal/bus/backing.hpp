// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "egocal/bus/answer_check.hpp"
#include "egocal/io/extrinsic_text.hpp"

namespace egocal::bus {

/// What the numbers of an answer to this problem rest on, of x y z roll pitch yaw. Its blocks are not looked
/// at.
std::array<Backing, 6> backing_of(const std::array<bool, 6>& observable, const Problem& problem);

/// Of an answer heard on the bus. Where its problem was not received, its method says of some whether it is
/// planar, and then z, roll and pitch are taken to come from the planes; has_nominal: what is known of the
/// problem otherwise, from the rig.
std::array<Backing, 6> backing_of(const CheckedAnswer& checked, const std::string& method, bool has_nominal);

}  // namespace egocal::bus
