// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::python {

/// A message of the library, which names options of the command line, with the arguments of solve() in their
/// place: "--time-offset auto" becomes "time_offset='auto'". Options that are no arguments here stay.
std::string in_python_words(std::string text);

}  // namespace egocal::python
