// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "warnings.hpp"

#include <fmt/format.h>

namespace egocal::tools {

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) fmt::print(stderr, "egocal: warning: {}\n", warning);
}

}  // namespace egocal::tools
