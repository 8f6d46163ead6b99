// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::tools {

/// A progress bar on standard error, on a terminal; silent otherwise.
class Progress {
 public:
  explicit Progress(std::string label);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void operator()(double part);  ///< 0 to 1

 private:
  std::string label_;
  bool terminal_ = false;
  int percent_ = -1;
};

}  // namespace egocal::tools
