// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace egocal::tools {

Progress::Progress(std::string label) : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (percent_ >= 0) std::fprintf(stderr, "\n");
}

void Progress::operator()(double part) {
  const int percent = static_cast<int>(100 * std::clamp(part, 0.0, 1.0));
  if (!terminal_ || percent == percent_) return;
  percent_ = percent;
  constexpr int width = 40;  // columns of the screen
  const std::string bar(static_cast<std::size_t>(percent * width / 100), '#');
  std::fprintf(stderr, "\r%s [%-*s] %3d %%", label_.c_str(), width, bar.c_str(), percent);
  std::fflush(stderr);
}

}  // namespace egocal::tools
