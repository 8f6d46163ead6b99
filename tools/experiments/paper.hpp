// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace egocal::tools {

/// Every table and figure of the paper in one run.
struct PaperOptions {
  /// Folder with kitti_05, kitti_07 and kitti_ground_planes (docs/paper.md); empty: simulated drives stand
  /// in.
  std::string data;
  std::string out = ".";
  bool full = false;  ///< Fig. 4 with the paper's 224,448 optimisations instead of a twentieth of them
  int repeats = 10;   ///< of each method, for its time, as in the paper
};

/// Writes the tables and figures, and OUT/paper.html with all of them beside the paper's printed numbers.
/// What is there already of the same options and version is kept, so a run that was interrupted continues.
/// progress: called with what is done next and the part that is done, 0 to 1. Returns the page's name. Throws
/// Error naming the file that cannot be read or written.
std::string reproduce_paper(const PaperOptions& options,
                            const std::function<void(const std::string&, double)>& progress);

}  // namespace egocal::tools
