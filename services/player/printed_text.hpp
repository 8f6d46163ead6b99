// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

namespace egocal::services {

/// std::snprintf() as a string, of at most 399 bytes.
template <class... Arguments>
std::string printed_text(const char* format, Arguments... arguments) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, arguments...);
  return buffer;
}

}  // namespace egocal::services
