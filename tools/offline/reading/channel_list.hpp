// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <set>
#include <string>

namespace egocal::tools {

/// Names of channels for an error message of one line: a damaged or hostile log may hold a million of them.
class ChannelList {
 public:
  void add(const std::string& name);
  /// At most ten of the names; "none" where there are none.
  std::string text() const;

 private:
  std::set<std::string> names_;
};

}  // namespace egocal::tools
