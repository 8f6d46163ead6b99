// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "convert.hpp"
#include "egocal/samples/calibrate_samples.hpp"

namespace egocal::python {

namespace {

using namespace pybind11::literals;

/// A rotation as a matrix (3, 3) or as a rotation vector of three numbers [rad]; a translation of three.
Pose pose_of(const py::handle& rotation, const py::handle& translation, const std::string& name) {
  const auto R = rotation.cast<Array>(), t = translation.cast<Array>();
  if ((R.size() != 9 && R.size() != 3) || t.size() != 3)
    throw py::value_error(name +
                          ": expected a 3 x 3 rotation or a rotation vector, and 3 numbers of translation");
  const Eigen::Vector3d vector(t.data()[0], t.data()[1], t.data()[2]);
  if (R.size() == 3) {
    const Eigen::Vector3d axis(R.data()[0], R.data()[1], R.data()[2]);
    if (!axis.allFinite() || !vector.allFinite()) throw py::value_error(name + ": not finite");
    return {rotation_exp(axis), vector};
  }
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = R.data()[i];
  matrix.topRightCorner<3, 1>() = vector;
  return to_pose(matrix, name.c_str());
}

std::vector<Pose> poses_of(const py::sequence& rotations, const py::sequence& translations,
                           const char* name) {
  if (rotations.size() != translations.size())
    throw py::value_error(std::string(name) + ": as many rotations as translations are expected");
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i)
    poses.push_back(pose_of(rotations[i], translations[i], std::string(name) + " " + std::to_string(i)));
  return poses;
}

py::object calibrate_hand_eye(const py::sequence& R_gripper2base, const py::sequence& t_gripper2base,
                              const py::sequence& R_target2cam, const py::sequence& t_target2cam,
                              bool details) {
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
  const Pose& X = calibration.T_a_b;
  const Eigen::Matrix3d R = X.rotation.toRotationMatrix();
  const Eigen::Vector3d t = X.translation;
  if (!details) return py::make_tuple(R, t);
  const Observability& observability = calibration.observability;
  const bool all = observability.observable == std::array<bool, 6>{true, true, true, true, true, true};
  std::vector<std::size_t> wrong;
  for (std::size_t i = 0; i < found.residuals.size(); ++i)
    if (found.residuals[i].wrong) wrong.push_back(i);
  return py::make_tuple(
      R, t,
      py::dict("verdict"_a = std::string(to_string(calibration.verdict)), "reason"_a = calibration.reason,
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
reason, certified, observable (six booleans), all_observable, stddev [m, rad], hint, wrong (indices of poses that
contradict the others and do not count), spread (median distance of the target over the poses [m]),
R_target2base and t_target2base. For a camera beside the arm pass base2gripper instead. Where the motions do not show a direction
the answer there is not a measurement: look at all_observable.)",
             "R_gripper2base"_a, "t_gripper2base"_a, "R_target2cam"_a, "t_target2cam"_a, py::kw_only(),
             "details"_a = false);
}

}  // namespace egocal::python
