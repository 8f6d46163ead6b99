// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "convert.hpp"
#include "egocal/samples/calibrate_samples.hpp"
#include "findings.hpp"
#include "warn.hpp"

namespace egocal::python {

namespace {

using namespace pybind11::literals;

/// The numbers of n rotations or translations: one array of them all, or a sequence of arrays.
class Rows {
 public:
  Rows(const py::sequence& rows, const char* name, const char* expected) {
    size_ = rows.size();
    if (py::isinstance<py::array>(rows)) {
      add(to_array(rows, name, expected), size_);
      return;
    }
    for (const py::handle row : rows) add(to_array(row, name, expected), 1);
  }
  std::size_t size() const { return size_; }
  std::size_t width(std::size_t i) const { return widths_[i]; }
  const double* operator[](std::size_t i) const { return numbers_.data() + begins_[i]; }

 private:
  void add(const Array& array, std::size_t rows) {
    const std::size_t width = rows > 0 ? static_cast<std::size_t>(array.size()) / rows : 0;
    for (std::size_t i = 0; i < rows; ++i) {
      begins_.push_back(numbers_.size() + i * width);
      widths_.push_back(width);
    }
    numbers_.insert(numbers_.end(), array.data(), array.data() + array.size());
  }

  std::size_t size_ = 0;
  std::vector<double> numbers_;
  std::vector<std::size_t> begins_, widths_;
};

void require_rotation_vector(const Eigen::Vector3d& axis, const char* list, std::size_t i) {
  constexpr double most = 1e6;  // [rad], limit: a double holds the angle of the last turn to 1e-10 there
  if (axis.allFinite() && axis.norm() < most) return;
  throw py::value_error(std::string(list) + " " + std::to_string(i) +
                        ": expected a rotation vector of finite numbers, less than 1e6 rad long");
}

/// Warns of what the tuple of R and t does not tell: poses that contradict the others.
void warn_of_wrong(const std::vector<std::size_t>& wrong, std::size_t poses) {
  if (wrong.empty()) return;
  std::string numbers;
  for (const std::size_t i : wrong) numbers += (numbers.empty() ? "" : ", ") + std::to_string(i);
  warn("calibrate_hand_eye: " + std::to_string(wrong.size()) + " of " + std::to_string(poses) +
       " poses contradict the others and do not count: " + numbers + " (the first is 0)");
}

/// A rotation as a matrix (3, 3) or as a rotation vector of three numbers [rad]; a translation of three.
Pose pose_of(const Rows& rotations, const Rows& translations, std::size_t i, const char* list) {
  const std::size_t width = rotations.width(i);
  if ((width != 9 && width != 3) || translations.width(i) != 3)
    throw py::value_error(std::string(list) + " " + std::to_string(i) +
                          ": expected a 3 x 3 rotation or a rotation vector, and 3 numbers of translation");
  const Eigen::Map<const Eigen::Vector3d> vector(translations[i]);
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topRightCorner<3, 1>() = vector;
  if (width == 3) {
    const Eigen::Vector3d axis = Eigen::Map<const Eigen::Vector3d>(rotations[i]);
    require_rotation_vector(axis, list, i);
    to_pose(matrix, list, i);  // the translation
    return {rotation_exp(axis), vector};
  }
  matrix.topLeftCorner<3, 3>() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotations[i]);
  return to_pose(matrix, list, i);
}

/// name: "gripper2base"; the arguments are R_gripper2base and t_gripper2base.
std::vector<Pose> poses_of(const py::object& R_list, const py::object& t_list, const char* name) {
  const auto of = [&](const py::object& list, const char* begin, const char* expected) {
    return to_sequence(list, (std::string(begin) + name).c_str(), expected);
  };
  const py::sequence rotations = of(R_list, "R_", "a sequence of 3 x 3 rotations or rotation vectors"),
                     translations = of(t_list, "t_", "a sequence of translations of 3 numbers");
  if (rotations.size() != translations.size())
    throw py::value_error(std::string(name) + ": as many rotations as translations are expected");
  const Rows R(rotations, name, "3 x 3 rotations or rotation vectors"),
      t(translations, name, "translations of 3 numbers");
  std::vector<Pose> poses;
  poses.reserve(R.size());
  for (std::size_t i = 0; i < R.size(); ++i) poses.push_back(pose_of(R, t, i, name));
  return poses;
}

py::object calibrate_hand_eye(const py::object& R_gripper2base, const py::object& t_gripper2base,
                              const py::object& R_target2cam, const py::object& t_target2cam,
                              const py::object& with_details) {
  const bool details = to_truth(with_details, "details");
  const std::vector<Pose> gripper = poses_of(R_gripper2base, t_gripper2base, "gripper2base"),
                          target = poses_of(R_target2cam, t_target2cam, "target2cam");
  if (gripper.size() != target.size())
    throw py::value_error("as many poses of the gripper as of the target are expected");
  if (gripper.size() < 3) throw py::value_error("at least three poses are expected");
  SampleCalibration found;
  {
    const py::gil_scoped_release release;
    std::vector<PoseSample> samples;
    for (std::size_t i = 0; i < gripper.size(); ++i)
      samples.push_back({to_dual_quaternion(gripper[i]), to_dual_quaternion(inverse(target[i]))});
    found = calibrate_samples(samples);
  }
  const Calibration& calibration = found.calibration;
  warn_of(calibration, {});
  std::vector<std::size_t> wrong;
  for (std::size_t i = 0; i < found.residuals.size(); ++i)
    if (found.residuals[i].wrong) wrong.push_back(i);
  warn_of_wrong(wrong, found.residuals.size());
  const Pose& X = calibration.T_a_b;
  const Eigen::Matrix3d R = X.rotation.toRotationMatrix();
  const Eigen::Vector3d t = X.translation;
  if (!details) return py::make_tuple(R, t);
  const Observability& observability = calibration.observability;
  const bool all = observability.observable == std::array<bool, 6>{true, true, true, true, true, true};
  return py::make_tuple(
      R, t,
      py::dict("verdict"_a = std::string(to_string(calibration.verdict)), "reason"_a = calibration.reason,
               "findings"_a = findings_of(calibration.findings),
               "certified"_a = calibration.certificate.optimality == Optimality::certified,
               "observable"_a = observability.observable, "all_observable"_a = all,
               "stddev"_a = Eigen::Matrix<double, 6, 1>(observability.stddev.data()),
               "hint"_a = observability.hint, "wrong"_a = wrong, "spread"_a = found.spread_median,
               "R_target2base"_a = Eigen::Matrix3d(found.T_world_a_world_b.rotation.toRotationMatrix()),
               "t_target2base"_a = Eigen::Vector3d(found.T_world_a_world_b.translation)));
}

}  // namespace

void bind_hand_eye(py::module_& module) {
  module.def("calibrate_hand_eye", &calibrate_hand_eye,
             R"(Pose of a camera in the gripper that carries it, from n still poses in any order.

The arguments are those of cv2.calibrateHandEye: sequences of n rotations ((3, 3), or rotation vectors) and of n
translations. Returns (R_cam2gripper (3, 3), t_cam2gripper (3,)); with details=True also a dict of verdict,
reason, findings (as Calibration.findings), certified, observable (six booleans), all_observable, stddev [m, rad], hint, wrong (indices of poses that
contradict the others and do not count), spread (median distance of the target over the poses [m]),
R_target2base and t_target2base. For a camera beside the arm pass base2gripper instead. Where the motions do not show a direction
the answer there is not a measurement: look at all_observable. An EgocalWarning is given where the verdict is
not good, and names the poses that do not count.)",
             "R_gripper2base"_a, "t_gripper2base"_a, "R_target2cam"_a, "t_target2cam"_a, py::kw_only(),
             "details"_a = false);
}

}  // namespace egocal::python
