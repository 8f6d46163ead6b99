// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "egocal/bus/answer_check.hpp"
#include "egocal/diagnosis/verdict.hpp"
#include "egocal/io/extrinsic_text.hpp"

namespace egocal::bus {

/// What each direction (x y z roll pitch yaw) of an answer to this problem is based on. The blocks of the
/// problem are not used.
std::array<Backing, 6> backing_of(const std::array<bool, 6>& observable, const Problem& problem);

/// The same for an answer that was heard on the bus. If its problem was not received, has_nominal says what
/// the rig file knows of it. Some methods are planar only; then z, roll and pitch are taken from the planes.
/// A direction that the statistics show, and of which the diagnosis found that both streams assume it, is
/// based on nothing. Null: the answer was not judged.
std::array<Backing, 6> backing_of(const CheckedAnswer& checked, const std::string& method, bool has_nominal,
                                  const Diagnosis* diagnosis = nullptr);

}  // namespace egocal::bus
