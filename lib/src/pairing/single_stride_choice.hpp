// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::detail {

/// The stride and balance that pair_motions() chooses for both streams, without the sums over many strides,
/// on which they do not depend: a quarter of the time. reason, mean_stride: of the single stride. Throws
/// Error as pair_motions().
Choice single_stride_choice(const PairingOptions& options, const Trajectory& a, const Trajectory& b);

}  // namespace egocal::detail
