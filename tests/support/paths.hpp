// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Folders of this checkout and its build. Only paths.cpp is compiled with them: every other object is the
// same in every checkout, so that a compiler cache serves all of them.
#pragma once

#include <string>

namespace egocal::paths {

std::string data_dir();    ///< the recorded drives, beside the project: ../shared/data
std::string bin_dir();     ///< our programs
std::string test_dir();    ///< the programs of the tests
std::string source_dir();  ///< the checkout

}  // namespace egocal::paths
