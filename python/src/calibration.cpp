// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/calibrate.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <string>

#include "convert.hpp"
#include "python_words.hpp"

namespace egocal::python {

namespace {

using namespace pybind11::literals;

/// "equal", "auto", or a pair of numbers (rotation, translation).
void set_weights(const py::object& weights, PairingOptions& pairing, bool stride_given) {
  if (!py::isinstance<py::str>(weights)) {
    constexpr const char* expected = "'auto', 'equal' or a pair of numbers";
    const Array pair = to_array(weights, "weights", expected);
    if (pair.ndim() != 1 || pair.size() != 2)
      throw py::value_error(std::string("weights: expected ") + expected);
    pairing.balance = Balance{pair.data()[0], pair.data()[1]};
    return;
  }
  const auto text = weights.cast<std::string>();
  if (text == "equal") {  // the paper's plain method: every motion of one step, no outliers
    pairing.balance = Balance{};
    pairing.robust = false;
    if (!stride_given) pairing.stride = 1;
  } else if (text != "auto") {
    throw py::value_error("weights: expected 'auto', 'equal' or a pair of numbers, got '" + text + "'");
  }
}

CalibrationOptions options_of(const std::string& method, const py::object& plane_a, const py::object& plane_b,
                              std::optional<int> stride, const py::object& weights,
                              const py::object& time_offset, double max_gap, const py::object& nominal) {
  CalibrationOptions options;
  const std::optional<Method> known = method_from_name(method);
  if (!known)
    throw py::value_error("method: expected global, fast, dual, sdp, sqp or slsqp, got '" + method + "'");
  options.method = *known;
  const std::optional<GroundPlane> a = to_plane(plane_a, "plane_a"), b = to_plane(plane_b, "plane_b");
  if (a.has_value() != b.has_value()) throw py::value_error("plane_a, plane_b: both or none");
  if (a) {
    options.pairing.mode = Mode::planar;
    options.pairing.plane_a = *a;
    options.pairing.plane_b = *b;
  }
  options.pairing.stride = stride;
  set_weights(weights, options.pairing, stride.has_value());
  if (py::isinstance<py::str>(time_offset)) {
    if (time_offset.cast<std::string>() != "auto")
      throw py::value_error("time_offset: expected seconds or 'auto'");
    options.estimate_time_offset = true;
  } else {
    options.pairing.time_offset = to_number(time_offset, "time_offset", "seconds or 'auto'");
  }
  options.pairing.max_gap = max_gap;
  if (!nominal.is_none()) {
    const Array matrix = to_array(nominal, "nominal", "a (4, 4) matrix");
    if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
      throw py::value_error("nominal: expected a (4, 4) matrix");
    using Rows = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
    const Eigen::Matrix4d pose = Eigen::Map<const Rows>(matrix.data());
    options.pairing.prior = to_dual_quaternion(to_pose(pose, "nominal"));
  }
  return options;
}

Calibration solve_trajectories(const py::object& a, const py::object& b, const std::string& method,
                               const py::object& plane_a, const py::object& plane_b,
                               std::optional<int> stride, const py::object& weights,
                               const py::object& time_offset, double max_gap, const py::object& nominal) {
  const CalibrationOptions options =
      options_of(method, plane_a, plane_b, stride, weights, time_offset, max_gap, nominal);
  const Trajectory trajectory_a = to_trajectory(a, "a"), trajectory_b = to_trajectory(b, "b");
  const py::gil_scoped_release release;
  return calibrate(trajectory_a, trajectory_b, options);
}

constexpr const char* solve_doc = R"(The extrinsic of two rigidly mounted sensors from their trajectories.

a, b: a file name (TUM, KITTI, EuRoC, csv; 'recording.mcap:/odom' for a bag), an (N, 8) array of rows
    t x y z qx qy qz qw [s, m], or a pair (times (N,) [s], matrices (N, 4, 4)). Each trajectory is in its own
    start frame.
method: 'global' (default) or 'fast', 'dual', 'sdp', 'sqp', 'slsqp'.
plane_a, plane_b: the ground seen from each sensor, (NX, NY, NZ, D), n . x = D, n up [m]: planar mode.
stride: steps of the slower stream in one motion; None: chosen.
weights: 'auto', 'equal' (the paper's plain method) or (rotation, translation).
time_offset: added to the times of b [s], or 'auto'.
max_gap: poses further apart are never interpolated between [s].
nominal: (4, 4), taken where the motions show nothing.

Returns a Calibration. Raises egocal.Error where nothing can be paired, ValueError for arguments that cannot be
understood. Releases the GIL.)";

void bind_answer(py::class_<Calibration>& type) {
  type.def_property_readonly(
          "T_a_b", [](const Calibration& c) { return to_matrix(c.T_a_b); },
          "(4, 4): pose of sensor b in the frame of sensor a, p_a = T_a_b p_b")
      .def_property_readonly(
          "T_b_a", [](const Calibration& c) { return to_matrix(c.T_b_a); }, "(4, 4): its inverse")
      .def_property_readonly(
          "translation", [](const Calibration& c) { return Eigen::Vector3d(c.T_a_b.translation); },
          "(3,): of T_a_b [m]")
      .def_property_readonly(
          "rotation_wxyz",
          [](const Calibration& c) {
            const auto& q = c.T_a_b.rotation;
            return Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
          },
          "(4,): unit quaternion of T_a_b, w x y z")
      .def_property_readonly(
          "verdict", [](const Calibration& c) { return std::string(to_string(c.verdict)); },
          "'good', 'incomplete', 'doubtful' or 'contradictory': whether the answer can be used")
      .def_property_readonly(
          "reason", [](const Calibration& c) { return in_python_words(c.reason); },
          "of the verdict, one sentence")
      .def_property_readonly(
          "statistics", [](const Calibration& c) { return sum_blocks(c.problem.blocks); },
          "Statistics of all motions: those of several drives of one rig add up")
      .def_property_readonly(
          "certified", [](const Calibration& c) { return c.certificate.optimality == Optimality::certified; },
          "no extrinsic has a lower cost: optimal, which is not the same as right")
      .def_property_readonly(
          "status", [](const Calibration& c) { return to_string(c.certificate.optimality); },
          "'certified', 'not optimal' or 'undecided'")
      .def_property_readonly(
          "cost", [](const Calibration& c) { return c.certificate.cost; }, "J of (16)")
      .def_property_readonly(
          "lower_bound", [](const Calibration& c) { return c.certificate.lower_bound; },
          "no extrinsic has a lower cost than this")
      .def_property_readonly(
          "gap", [](const Calibration& c) { return c.certificate.gap; }, "cost - lower_bound");
}

void bind_details(py::class_<Calibration>& type) {
  type.def_property_readonly(
          "observable", [](const Calibration& c) { return c.observability.observable; },
          "six booleans: x y z roll pitch yaw in the frame of a")
      .def_property_readonly(
          "stddev",
          [](const Calibration& c) { return Eigen::Matrix<double, 6, 1>(c.observability.stddev.data()); },
          "(6,): standard deviations [m, rad]; infinite where not observable")
      .def_property_readonly(
          "hint", [](const Calibration& c) { return c.observability.hint; },
          "which motion would help most; empty where nothing is missing")
      .def_property_readonly(
          "pairs", [](const Calibration& c) { return sum_blocks(c.problem.blocks).count; },
          "motion pairs used")
      .def_property_readonly(
          "outliers", [](const Calibration& c) { return c.counts.outliers; },
          "motion pairs that contradict the others")
      .def_property_readonly(
          "rejected",
          [](const Calibration& c) {
            py::dict reasons;
            for (std::size_t i = 0; i < c.counts.rejected.size(); ++i)
              reasons[py::str(std::string(to_string(static_cast<Rejection>(i))))] = c.counts.rejected[i];
            return reasons;
          },
          "number of poses and motions rejected, by reason")
      .def_property_readonly(
          "stride", [](const Calibration& c) { return c.choice.stride; }, "steps in one motion")
      .def_property_readonly(
          "weights",
          [](const Calibration& c) {
            return std::pair(c.choice.balance.rotation, c.choice.balance.translation);
          },
          "of rotation and translation")
      .def_property_readonly(
          "time_offset", [](const Calibration& c) { return c.time_offset_applied; },
          "added to the times of b [s]")
      .def("__repr__", [](const Calibration& c) {
        const Eigen::Vector3d t = c.T_a_b.translation;
        return "<egocal.Calibration translation [" + std::to_string(t.x()) + ", " + std::to_string(t.y()) +
               ", " + std::to_string(t.z()) + "] m, " + std::string(to_string(c.certificate.optimality)) +
               ">";
      });
}

}  // namespace

void bind_calibration(py::module_& module) {
  py::class_<Calibration> type(module, "Calibration", "Everything known about one pair of sensors [m, rad].");
  bind_answer(type);
  bind_details(type);
  module.def("solve", &solve_trajectories, solve_doc, "a"_a, "b"_a, py::kw_only(), "method"_a = "global",
             "plane_a"_a = py::none(), "plane_b"_a = py::none(), "stride"_a = py::none(),
             "weights"_a = "auto", "time_offset"_a = 0.0, "max_gap"_a = PairingOptions{}.max_gap,
             "nominal"_a = py::none());
}

}  // namespace egocal::python
