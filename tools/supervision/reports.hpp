// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>

namespace egocal::tools {

/// What the supervisor reports. Where the screen is the monitor's, lines go to a file, the last one also to
/// the screen in the end.
class Reports {
 public:
  /// quiet: lines go to up.out in this folder; an empty folder is none, and all goes to standard error.
  Reports(std::string folder, bool quiet) : folder_(std::move(folder)), quiet_(quiet) {}
  ~Reports();
  Reports(const Reports&) = delete;
  Reports& operator=(const Reports&) = delete;

  void report(const std::string& line, bool at_the_end_too = false);
  void end() const;

 private:
  std::string folder_;
  bool quiet_;
  int output_ = -1;
  std::string last_line_;
};

}  // namespace egocal::tools
