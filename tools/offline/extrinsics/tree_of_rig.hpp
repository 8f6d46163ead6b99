// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/io/extrinsic_tree.hpp"
#include "offline/rig/calibration.hpp"

namespace egocal::tools {

/// The tree that is printed and exported: the joint one or that of the pairs (RigReport::joint). Each edge
/// has the standard deviations and the verdict of the answer that it is, or why it should not be used.
ExtrinsicTree tree_of(const RigReport& report);

}  // namespace egocal::tools
