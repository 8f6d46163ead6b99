// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "paths.hpp"

namespace egocal::paths {

std::string data_dir() {
  return EGOCAL_DATA_DIR;
}

std::string bin_dir() {
  return EGOCAL_BIN_DIR;
}

std::string test_dir() {
  return EGOCAL_TEST_DIR;
}

std::string source_dir() {
  return EGOCAL_SOURCE_DIR;
}

}  // namespace egocal::paths
