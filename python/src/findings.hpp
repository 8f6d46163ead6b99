// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Findings for Python, and what is pickled of them and of poses.
#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "egocal/diagnosis/verdict.hpp"

namespace egocal::python {

/// x y z w x y z: translation [m] and quaternion, w first.
pybind11::tuple numbers_of(const Pose& pose);
Pose pose_of(const pybind11::handle& numbers);

/// Dicts with the keys of `egocal solve --json` (docs/json.md).
pybind11::list findings_of(const std::vector<Finding>& findings);

/// The findings for pickling: all that findings_of() shows.
pybind11::list states_of(const std::vector<Finding>& findings);
std::vector<Finding> findings_from(const pybind11::handle& states);

}  // namespace egocal::python
