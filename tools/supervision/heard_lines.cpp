// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/heard_lines.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstddef>

namespace egocal::tools {

std::vector<std::string> HeardLines::read() {
  std::vector<std::string> lines;
  char part[4096];
  const ssize_t n = ::read(descriptor_, part, sizeof part);
  if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) descriptor_ = -1;
  if (n <= 0) return lines;
  part_.append(part, static_cast<std::size_t>(n));
  for (std::size_t end = part_.find('\n'); end != std::string::npos; end = part_.find('\n')) {
    lines.push_back(part_.substr(0, end));
    part_.erase(0, end + 1);
  }
  return lines;
}

}  // namespace egocal::tools
