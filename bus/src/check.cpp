// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/check.hpp"

#include <stdexcept>
#include <string>
#include <string_view>

namespace egocal::bus {

void contradiction(const char* what, const char* file, long line) {
  std::string_view name(file);
  name.remove_prefix(name.rfind('/') + 1);  // npos + 1 is 0
  throw std::logic_error("a defect in this program, please report it: it does not hold that " +
                         std::string(what) + " (" + std::string(name) + ":" + std::to_string(line) + ")");
}

}  // namespace egocal::bus
