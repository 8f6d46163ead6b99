// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/version.hpp"

#define EGOCAL_TEXT_OF(number) #number
#define EGOCAL_TEXT(number) EGOCAL_TEXT_OF(number)

namespace egocal {

const char* version() {
  return EGOCAL_TEXT(EGOCAL_VERSION_MAJOR) "." EGOCAL_TEXT(EGOCAL_VERSION_MINOR) "." EGOCAL_TEXT(
      EGOCAL_VERSION_PATCH);
}

}  // namespace egocal
