// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "convert.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "egocal/in_words.hpp"
#include "egocal/io/checked_pose.hpp"
#include "egocal/io/recording.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/limits.hpp"
#include "egocal/microseconds.hpp"
#include "python_words.hpp"

namespace egocal::python {

namespace {

[[noreturn]] void refuse(const char* name, const std::string& why) {
  throw py::value_error(std::string(name) + ": " + why);
}

constexpr const char* forms =
    "a file name, an (N, 8) array of t x y z qx qy qz qw, or a pair of times (N,) and matrices (N, 4, 4)";

std::string text(const char* format, double value) {
  char buffer[100];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::int64_t to_time_us(double seconds, const char* name, py::ssize_t row) {
  // a larger double cannot hold microseconds, and differences of larger times could overflow
  if (!std::isfinite(seconds) || std::abs(seconds) > 9e9)
    refuse(name, "row " + std::to_string(row) + ": expected a time in seconds, got " + text("%.4g", seconds));
  return to_microseconds(seconds);
}

/// Refuses times of four bytes, which hold a date to two minutes only. times: the first column.
void require_fine_times(const py::handle& object, double largest, const char* name) {
  constexpr double coarsest = 1e-3;  // [s]: a tenth of the period of a fast sensor
  const py::array array = py::array::ensure(object);
  if (!array || array.dtype().kind() != 'f' || array.itemsize() >= 8) return;
  const double step = largest * (array.itemsize() == 4 ? 0x1p-23 : 0x1p-10);
  if (step > coarsest)
    refuse(name, "its times are " + text("%.2g", step) + " s apart in float" +
                     std::to_string(8 * array.itemsize()) + ": give them as float64");
}

/// The trajectory sorted by time, the first of equal times kept.
Trajectory in_order(Trajectory trajectory, const char* name, std::vector<std::string>& notes) {
  TrajectoryReading reading;
  reading.trajectory = std::move(trajectory);
  put_in_order(reading);
  const std::string start = std::string(name) + ": ";
  if (reading.out_of_order > 0)
    notes.push_back(start + counted(reading.out_of_order, "pose") + " out of order: sorted by time");
  if (reading.duplicates > 0)
    notes.push_back(start + counted(reading.duplicates, "pose") +
                    " with the time of another one: the first of each is kept");
  return std::move(reading.trajectory);
}

Trajectory from_rows(const Array& rows, const char* name, std::vector<std::string>& notes) {
  if (rows.ndim() != 2 || rows.shape(1) != 8) refuse(name, "expected an (N, 8) array of t x y z qx qy qz qw");
  Trajectory trajectory;
  const auto at = rows.unchecked<2>();
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    const detail::CheckedPose checked =
        detail::checked_pose({at(i, 1), at(i, 2), at(i, 3)}, {at(i, 7), at(i, 4), at(i, 5), at(i, 6)});
    if (!checked.reason.empty()) refuse(name, "row " + std::to_string(i) + ": not a pose: " + checked.reason);
    trajectory.push_back({to_time_us(at(i, 0), name, i), checked.pose});
  }
  return in_order(std::move(trajectory), name, notes);
}

Trajectory from_matrices(const Array& times, const Array& matrices, const char* name,
                         std::vector<std::string>& notes) {
  if (times.ndim() != 1 || matrices.ndim() != 3 || matrices.shape(1) != 4 || matrices.shape(2) != 4 ||
      times.shape(0) != matrices.shape(0))
    refuse(name, "expected a pair of times (N,) and matrices (N, 4, 4)");
  Trajectory trajectory;
  const auto at = matrices.unchecked<3>();
  for (py::ssize_t i = 0; i < times.shape(0); ++i) {
    Eigen::Matrix4d matrix;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) matrix(row, column) = at(i, row, column);
    trajectory.push_back({to_time_us(times.at(i), name, i),
                          to_dual_quaternion(to_pose(matrix, name, static_cast<std::size_t>(i)))});
  }
  return in_order(std::move(trajectory), name, notes);
}

constexpr const char* not_rigid =
    "not a rigid displacement (rotation, translation of less than 1e9 m, last row 0 0 0 1)";

bool rigid(const Eigen::Matrix4d& matrix) {
  constexpr double tolerance = 1e-3;  // what three printed decimals of a rotation matrix leave
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  return matrix.allFinite() && plausible_distance(matrix.topRightCorner<3, 1>().cwiseAbs().maxCoeff()) &&
         (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < tolerance &&
         R.determinant() > 0 &&
         (matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < tolerance;
}

Pose pose_of_rigid(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  return {Eigen::Quaterniond(R).normalized(), matrix.topRightCorner<3, 1>()};
}

template <int size>
Eigen::Matrix<double, size, size> square_of(const py::handle& object, const char* name,
                                            const char* expected) {
  const Array matrix = to_array(object, name, expected);
  if (matrix.ndim() != 2 || matrix.shape(0) != size || matrix.shape(1) != size)
    refuse(name, std::string("expected ") + expected);
  return Eigen::Map<const Eigen::Matrix<double, size, size, Eigen::RowMajor>>(matrix.data());
}

/// The name of a file from a str or a path-like object. The library takes file names and gives messages in
/// UTF-8.
std::string to_file_name(const py::handle& object, const char* name) {
  const py::module_ os = py::module_::import("os");
  const py::object path = os.attr("fsdecode")(os.attr("fspath")(object));
  Py_ssize_t size = 0;
  const char* const utf8 = PyUnicode_AsUTF8AndSize(path.ptr(), &size);
  if (!utf8) {
    PyErr_Clear();
    refuse(name, "the file name is not in UTF-8: " + py::repr(path).cast<std::string>());
  }
  std::string file(utf8, static_cast<std::size_t>(size));
  if (file.empty()) refuse(name, "the file name is empty");
  if (file.find('\0') != std::string::npos)
    refuse(name, "the file name has a null character: " + py::repr(path).cast<std::string>());
  return file;
}

double largest_time(const Array& numbers, py::ssize_t step) {
  double largest = 0;
  for (py::ssize_t i = 0; i < numbers.size(); i += step)
    if (std::isfinite(numbers.data()[i])) largest = std::max(largest, std::abs(numbers.data()[i]));
  return largest;
}

}  // namespace

Array to_array(const py::handle& object, const char* name, const char* expected) {
  if (py::module_::import("numpy").attr("ma").attr("is_masked")(object).cast<bool>())
    refuse(name, "has masked entries: leave these rows out");
  const py::array array = py::array::ensure(object);
  if (array && array.dtype().kind() == 'c') refuse(name, "expected real numbers, got complex ones");
  const Array numbers = array ? Array::ensure(array) : Array::ensure(object);
  if (!numbers) refuse(name, std::string("expected ") + expected);
  return numbers;
}

namespace {

/// "expected seconds, got None", with the type of what has a long text.
[[noreturn]] void refuse_type(const py::handle& object, const char* name, const char* expected) {
  const bool shown = object.is_none() || py::isinstance<py::bool_>(object) ||
                     py::isinstance<py::int_>(object) || py::isinstance<py::float_>(object);
  refuse(name, std::string("expected ") + expected + ", got " +
                   (shown ? py::repr(object).cast<std::string>().substr(0, 40)
                          : "a value of type " + std::string(Py_TYPE(object.ptr())->tp_name)));
}

template <typename Value>
Value to_value(const py::handle& object, const char* name, const char* expected) {
  try {
    return object.cast<Value>();
  } catch (const py::cast_error&) {
    refuse_type(object, name, expected);
  }
}

}  // namespace

double to_number(const py::handle& object, const char* name, const char* expected) {
  return to_value<double>(object, name, expected);
}

int to_whole_number(const py::handle& object, const char* name, const char* expected) {
  return to_value<int>(object, name, expected);
}

bool to_truth(const py::handle& object, const char* name) {
  return to_value<bool>(object, name, "True or False");
}

std::string to_text(const py::handle& object, const char* name, const char* expected) {
  return to_value<std::string>(object, name, expected);
}

py::sequence to_sequence(const py::handle& object, const char* name, const char* expected) {
  if (PySequence_Check(object.ptr()) == 0 || PySequence_Size(object.ptr()) < 0) {
    PyErr_Clear();
    refuse_type(object, name, expected);
  }
  return py::reinterpret_borrow<py::sequence>(object);
}

Eigen::Matrix4d to_matrix4(const py::handle& object, const char* name) {
  return square_of<4>(object, name, "a (4, 4) matrix");
}

Eigen::Matrix<double, 8, 8> to_matrix8(const py::handle& object, const char* name) {
  return square_of<8>(object, name, "an (8, 8) matrix");
}

Eigen::Matrix4d to_matrix(const Pose& T) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = T.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = T.translation;
  return matrix;
}

Pose to_pose(const Eigen::Matrix4d& matrix, const char* name) {
  if (!rigid(matrix)) refuse(name, not_rigid);
  return pose_of_rigid(matrix);
}

Pose to_pose(const Eigen::Matrix4d& matrix, const char* name, std::size_t number) {
  if (!rigid(matrix)) refuse((std::string(name) + " " + std::to_string(number)).c_str(), not_rigid);
  return pose_of_rigid(matrix);
}

Trajectory to_trajectory(const py::handle& object, const char* name, std::vector<std::string>& notes) {
  if (py::isinstance<py::str>(object) || py::hasattr(object, "__fspath__")) {
    const std::string file = to_file_name(object, name);
    const py::gil_scoped_release release;
    TrajectoryReading reading = read_trajectory_file(file);
    for (const std::string& note : reading.notes) notes.push_back(file + ": " + in_python_words(note));
    return std::move(reading.trajectory);
  }
  if (py::isinstance<py::tuple>(object)) {
    const auto pair = object.cast<py::tuple>();
    if (pair.size() != 2) refuse(name, "expected a pair of times (N,) and matrices (N, 4, 4)");
    const Array times = to_array(pair[0], name, forms), matrices = to_array(pair[1], name, forms);
    require_fine_times(pair[0], largest_time(times, 1), name);
    return from_matrices(times, matrices, name, notes);
  }
  const Array rows = to_array(object, name, forms);
  if (rows.ndim() == 2 && rows.shape(1) == 8) require_fine_times(object, largest_time(rows, 8), name);
  return from_rows(rows, name, notes);
}

std::optional<GroundPlane> to_plane(const py::object& object, const char* name) {
  if (object.is_none()) return std::nullopt;
  constexpr const char* expected = "four numbers NX NY NZ D";
  const Array array = to_array(object, name, expected);
  if (array.ndim() != 1 || array.size() != 4) refuse(name, std::string("expected ") + expected);
  const double* const numbers = array.data();
  return GroundPlane{{numbers[0], numbers[1], numbers[2]}, numbers[3]};
}

}  // namespace egocal::python
