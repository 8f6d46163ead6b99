// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "egocal/geometry/dual_quaternion.hpp"
#include "egocal/geometry/pose.hpp"
#include "egocal/pairing/trajectory.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::python {

namespace py = pybind11;

/// Numbers in C order, converted where they are of another type.
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Throws ValueError where the object holds no numbers, masked or complex ones. name: the argument, expected:
/// its shape, for the message.
Array to_array(const py::handle& object, const char* name, const char* expected);
/// One number; throws ValueError likewise.
double to_number(const py::handle& object, const char* name, const char* expected);
/// A whole number of the size of an int, True or False, a text; throw ValueError likewise.
int to_whole_number(const py::handle& object, const char* name, const char* expected);
bool to_truth(const py::handle& object, const char* name);
std::string to_text(const py::handle& object, const char* name, const char* expected);
/// A sequence that has a length; throws ValueError likewise.
py::sequence to_sequence(const py::handle& object, const char* name, const char* expected);

/// (4, 4) and (8, 8) numbers; throw ValueError likewise.
Eigen::Matrix4d to_matrix4(const py::handle& object, const char* name);
Eigen::Matrix<double, 8, 8> to_matrix8(const py::handle& object, const char* name);

/// A 4 x 4 homogeneous matrix.
Eigen::Matrix4d to_matrix(const Pose& T);
/// Throws ValueError where the matrix is not a rigid displacement: not finite, last row not 0 0 0 1, a
/// rotation that is off by more than 1e-3, or 1e9 m long. name: the argument, for the message.
Pose to_pose(const Eigen::Matrix4d& matrix, const char* name);
/// The same for one of many: the message has its number.
Pose to_pose(const Eigen::Matrix4d& matrix, const char* name, std::size_t number);

/// A trajectory in any of the forms that solve() accepts: a file name (with :topic for a bag), an (N, 8)
/// array of t x y z qx qy qz qw [s, m], or a pair (times (N,) [s], matrices (N, 4, 4)). Unsorted rows are
/// sorted, repeated times dropped. What was assumed, repaired or lost goes to the notes, with the file's name
/// or the argument's. Throws ValueError naming the argument and the row.
Trajectory to_trajectory(const py::handle& object, const char* name, std::vector<std::string>& notes);

/// Four numbers NX NY NZ D, n . x = D with the unit normal n up; empty for None.
std::optional<GroundPlane> to_plane(const py::object& object, const char* name);

void bind_calibration(py::module_& module);
void bind_statistics(py::module_& module);
void bind_hand_eye(py::module_& module);

}  // namespace egocal::python
