// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace egocal::tools {

/// Lines of a file descriptor that does not block, as they come.
class HeardLines {
 public:
  /// -1: none.
  explicit HeardLines(int descriptor) : descriptor_(descriptor) {}

  int descriptor() const { return descriptor_; }
  /// The lines that are complete now, without their ends. What has ended has the descriptor -1 from then on.
  std::vector<std::string> read();

 private:
  int descriptor_;
  std::string part_;  ///< the beginning of a line
};

}  // namespace egocal::tools
