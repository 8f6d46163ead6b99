// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "egocal/calibrate.hpp"

namespace egocal::python {

/// Adds EgocalWarning, the category of all warnings of this module.
void bind_warning(pybind11::module_& module);

/// Warns at the line that called this module. Throws if the filters turn the warning into an exception.
void warn(const std::string& text);
/// Warns of each note of reading, and of a verdict that is not good, with its reason. If the verdict is good,
/// of what is certainly wrong nevertheless.
void warn_of(const Calibration& calibration, const std::vector<std::string>& notes);

}  // namespace egocal::python
