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

/// Warns at the line that called this module. Throws where the filters make an exception of it.
void warn(const std::string& text);
/// Of each note of reading, and of a verdict that is not good, with its reason; of one that is, of what is
/// wrong for certain all the same.
void warn_of(const Calibration& calibration, const std::vector<std::string>& notes);

}  // namespace egocal::python
