// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::python {

/// A message of the library in terms of Python: options of the command line become arguments of solve(),
/// "--time-offset auto" becomes "time_offset='auto'". Options without an argument stay.
std::string in_python_words(std::string text);

}  // namespace egocal::python
