// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "silence.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace egocal::bench {

Silence::Silence() {
  std::fflush(stdout);
  std::cout.flush();
  kept_ = dup(STDOUT_FILENO);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  close(nowhere);
}

Silence::~Silence() {
  std::fflush(stdout);
  std::cout.flush();
  dup2(kept_, STDOUT_FILENO);
  close(kept_);
}

}  // namespace egocal::bench
