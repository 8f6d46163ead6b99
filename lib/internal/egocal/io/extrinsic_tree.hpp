// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "egocal/io/extrinsic_text.hpp"

namespace egocal {

/// The extrinsics of a rig as one tree of frames, as URDF and tf want it: every sensor but the root has
/// exactly one parent.
struct ExtrinsicTree {
  std::string root;
  std::vector<NamedExtrinsic> edges;  ///< parents first; a reversed pair has no standard deviations
  /// Pairs that would close a loop: less certain than the way through the tree, and not part of it.
  std::vector<NamedExtrinsic> unused;
};

/// The tree of the most certain pairs: certified and usable before others, then the smaller standard
/// deviation of the translation. root: empty: the parent of the first pair. Throws Error where the pairs do
/// not connect every sensor, naming one that cannot be reached.
ExtrinsicTree extrinsic_tree(const std::vector<NamedExtrinsic>& pairs, const std::string& root = "");

/// Whether a file of this format holds several extrinsics.
bool holds_tree(ExtrinsicFormat format);

/// The names of those formats: "urdf, ros, ros-launch, yaml or json".
std::string tree_format_names();

/// The whole text of a file: urdf (a robot), ros, ros_launch, yaml (one document an edge), json (`root` and
/// `edges`). Throws Error for the formats that hold one extrinsic only.
std::string extrinsic_tree_text(const ExtrinsicTree& tree, ExtrinsicFormat format);

}  // namespace egocal
