// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/calibrate.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <array>
#include <string>
#include <vector>

#include "convert.hpp"
#include "findings.hpp"
#include "python_words.hpp"
#include "warn.hpp"

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

CalibrationOptions options_of(const py::object& method, const py::object& plane_a, const py::object& plane_b,
                              const py::object& stride, const py::object& weights,
                              const py::object& time_offset, const py::object& max_gap,
                              const py::object& nominal) {
  CalibrationOptions options;
  const std::string name = to_text(method, "method", "global, fast, dual, sdp, sqp or slsqp");
  const std::optional<Method> known = method_from_name(name);
  if (!known)
    throw py::value_error("method: expected global, fast, dual, sdp, sqp or slsqp, got '" + name + "'");
  options.method = *known;
  const std::optional<GroundPlane> a = to_plane(plane_a, "plane_a"), b = to_plane(plane_b, "plane_b");
  if (a.has_value() != b.has_value()) throw py::value_error("plane_a, plane_b: both or none");
  if (a) {
    options.pairing.mode = Mode::planar;
    options.pairing.plane_a = *a;
    options.pairing.plane_b = *b;
  }
  if (!stride.is_none()) options.pairing.stride = to_whole_number(stride, "stride", "a whole number or None");
  set_weights(weights, options.pairing, !stride.is_none());
  if (py::isinstance<py::str>(time_offset)) {
    if (time_offset.cast<std::string>() != "auto")
      throw py::value_error("time_offset: expected seconds or 'auto'");
    options.estimate_time_offset = true;
  } else {
    options.pairing.time_offset = to_number(time_offset, "time_offset", "seconds or 'auto'");
  }
  options.pairing.max_gap = to_number(max_gap, "max_gap", "seconds");
  if (!nominal.is_none())
    options.pairing.prior = to_dual_quaternion(to_pose(to_matrix4(nominal, "nominal"), "nominal"));
  return options;
}

/// A calibration with what was noted while its streams were read.
struct NotedCalibration : Calibration {
  std::vector<std::string> notes;
};

NotedCalibration solve_quietly(const py::object& a, const py::object& b, const py::object& method,
                               const py::object& plane_a, const py::object& plane_b, const py::object& stride,
                               const py::object& weights, const py::object& time_offset,
                               const py::object& max_gap, const py::object& nominal) {
  const CalibrationOptions options =
      options_of(method, plane_a, plane_b, stride, weights, time_offset, max_gap, nominal);
  NotedCalibration result;
  const Trajectory trajectory_a = to_trajectory(a, "a", result.notes),
                   trajectory_b = to_trajectory(b, "b", result.notes);
  const py::gil_scoped_release release;
  static_cast<Calibration&>(result) = calibrate(trajectory_a, trajectory_b, options);
  return result;
}

NotedCalibration solve_trajectories(const py::object& a, const py::object& b, const py::object& method,
                                    const py::object& plane_a, const py::object& plane_b,
                                    const py::object& stride, const py::object& weights,
                                    const py::object& time_offset, const py::object& max_gap,
                                    const py::object& nominal) {
  NotedCalibration result =
      solve_quietly(a, b, method, plane_a, plane_b, stride, weights, time_offset, max_gap, nominal);
  warn_of(result, result.notes);
  return result;
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
nominal: (4, 4), taken where the motions show nothing; with plane_a, plane_b the answer is compared with it.

Returns a Calibration. Its verdict tells whether it can be used: an EgocalWarning is given where that is not
'good', for certain findings (Calibration.findings) of one that is, and for what was assumed, repaired or lost while
reading (Calibration.notes). Raises egocal.Error where nothing can be paired, ValueError for arguments that cannot be
understood. Releases the GIL.)";

/// The verdict first: the numbers are those of a mount only where it is good.
std::string in_brackets(const NotedCalibration& c) {
  std::string text = "<egocal.Calibration " + std::string(to_string(c.verdict)) + ": translation [";
  for (std::size_t i = 0; i < 3; ++i) {
    const bool known = c.observability.observable[i] || c.problem.mode == Mode::planar || c.problem.prior;
    text += (i > 0 ? ", " : "") +
            (known ? std::to_string(c.T_a_b.translation[static_cast<Eigen::Index>(i)]) : "unknown");
  }
  return text + "] m, " + std::string(to_string(c.certificate.optimality)) + ">";
}

constexpr int state_version = 2;  // of what is pickled

/// All that Python can ask for.
py::tuple state_of(const NotedCalibration& c) {
  const Certificate& certificate = c.certificate;
  const Observability& observability = c.observability;
  return py::make_tuple(
      state_version, numbers_of(c.T_a_b), numbers_of(c.T_b_a),
      py::make_tuple(static_cast<int>(c.verdict), c.reason),
      py::make_tuple(static_cast<int>(certificate.optimality), certificate.cost, certificate.lower_bound,
                     certificate.gap),
      py::make_tuple(observability.observable, observability.stddev, observability.hint),
      py::make_tuple(c.problem.mode == Mode::planar, c.problem.prior.has_value(),
                     sum_blocks(c.problem.blocks)),
      py::make_tuple(c.counts.outliers, c.counts.rejected),
      py::make_tuple(c.choice.stride, c.choice.balance.rotation, c.choice.balance.translation),
      c.time_offset_applied, c.notes, states_of(c.findings));
}

NotedCalibration from_state(const py::tuple& state) {
  if (state.size() != 12 || state[0].cast<int>() != state_version)
    throw py::value_error("Calibration: pickled by another version of egocal");
  const auto part = [&](std::size_t i) { return state[i].cast<py::tuple>(); };
  NotedCalibration c;
  c.T_a_b = pose_of(state[1]);
  c.T_b_a = pose_of(state[2]);
  const py::tuple verdict = part(3), certificate = part(4), seen = part(5), problem = part(6),
                  counts = part(7), choice = part(8);
  c.verdict = static_cast<Verdict>(verdict[0].cast<int>());
  c.reason = verdict[1].cast<std::string>();
  c.certificate.optimality = static_cast<Optimality>(certificate[0].cast<int>());
  c.certificate.cost = certificate[1].cast<double>();
  c.certificate.lower_bound = certificate[2].cast<double>();
  c.certificate.gap = certificate[3].cast<double>();
  c.observability.observable = seen[0].cast<std::array<bool, 6>>();
  c.observability.stddev = seen[1].cast<std::array<double, 6>>();
  c.observability.hint = seen[2].cast<std::string>();
  c.problem.mode = problem[0].cast<bool>() ? Mode::planar : Mode::spatial;
  if (problem[1].cast<bool>()) c.problem.prior.emplace();
  c.problem.blocks = {problem[2].cast<Statistics>()};
  c.counts.outliers = counts[0].cast<std::uint64_t>();
  c.counts.rejected = counts[1].cast<decltype(c.counts.rejected)>();
  c.choice.stride = choice[0].cast<int>();
  c.choice.balance = {choice[1].cast<double>(), choice[2].cast<double>()};
  c.time_offset_applied = state[9].cast<double>();
  c.notes = state[10].cast<std::vector<std::string>>();
  c.findings = findings_from(state[11]);
  return c;
}

void bind_answer(py::class_<NotedCalibration>& type) {
  type.def_property_readonly(
          "T_a_b", [](const NotedCalibration& c) { return to_matrix(c.T_a_b); },
          "(4, 4): pose of sensor b in the frame of sensor a, p_a = T_a_b p_b")
      .def_property_readonly(
          "T_b_a", [](const NotedCalibration& c) { return to_matrix(c.T_b_a); }, "(4, 4): its inverse")
      .def_property_readonly(
          "translation", [](const NotedCalibration& c) { return Eigen::Vector3d(c.T_a_b.translation); },
          "(3,): of T_a_b [m]")
      .def_property_readonly(
          "rotation_wxyz",
          [](const NotedCalibration& c) {
            const auto& q = c.T_a_b.rotation;
            return Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
          },
          "(4,): unit quaternion of T_a_b, w x y z")
      .def_property_readonly(
          "verdict", [](const NotedCalibration& c) { return std::string(to_string(c.verdict)); },
          "'good', 'incomplete', 'doubtful' or 'contradictory': whether the answer can be used")
      .def_property_readonly(
          "reason", [](const NotedCalibration& c) { return in_python_words(c.reason); },
          "of the verdict, one sentence")
      .def_property_readonly(
          "findings", [](const NotedCalibration& c) { return findings_of(c.findings); },
          "what was found, the most important first: dicts with the keys of `egocal solve --json`, code, "
          "certain, message, remedy, improvement and, where there is one, value, time [s], translation, "
          "rotation_wxyz")
      .def_property_readonly(
          "statistics", [](const NotedCalibration& c) { return sum_blocks(c.problem.blocks); },
          "Statistics of all motions: those of several drives of one rig add up")
      .def_property_readonly(
          "certified",
          [](const NotedCalibration& c) { return c.certificate.optimality == Optimality::certified; },
          "no extrinsic has a lower cost: optimal, which is not the same as right")
      .def_property_readonly(
          "status", [](const NotedCalibration& c) { return to_string(c.certificate.optimality); },
          "'certified', 'not optimal' or 'undecided'")
      .def_property_readonly(
          "cost", [](const NotedCalibration& c) { return c.certificate.cost; }, "J of (16)")
      .def_property_readonly(
          "lower_bound", [](const NotedCalibration& c) { return c.certificate.lower_bound; },
          "no extrinsic has a lower cost than this")
      .def_property_readonly(
          "gap", [](const NotedCalibration& c) { return c.certificate.gap; }, "cost - lower_bound");
}

void bind_details(py::class_<NotedCalibration>& type) {
  type.def_property_readonly(
          "observable", [](const NotedCalibration& c) { return c.observability.observable; },
          "six booleans: x y z roll pitch yaw in the frame of a")
      .def_property_readonly(
          "stddev",
          [](const NotedCalibration& c) {
            return Eigen::Matrix<double, 6, 1>(c.observability.stddev.data());
          },
          "(6,): standard deviations [m, rad]; infinite where not observable")
      .def_property_readonly(
          "hint", [](const NotedCalibration& c) { return c.observability.hint; },
          "which motion would help most; empty where nothing is missing")
      .def_property_readonly(
          "pairs", [](const NotedCalibration& c) { return sum_blocks(c.problem.blocks).count; },
          "motion pairs used")
      .def_property_readonly(
          "outliers", [](const NotedCalibration& c) { return c.counts.outliers; },
          "motion pairs that contradict the others")
      .def_property_readonly(
          "rejected",
          [](const NotedCalibration& c) {
            py::dict reasons;
            for (std::size_t i = 0; i < c.counts.rejected.size(); ++i)
              reasons[py::str(std::string(to_string(static_cast<Rejection>(i))))] = c.counts.rejected[i];
            return reasons;
          },
          "number of poses and motions rejected, by reason")
      .def_property_readonly(
          "stride", [](const NotedCalibration& c) { return c.choice.stride; }, "steps in one motion")
      .def_property_readonly(
          "weights",
          [](const NotedCalibration& c) {
            return std::pair(c.choice.balance.rotation, c.choice.balance.translation);
          },
          "of rotation and translation")
      .def_property_readonly(
          "time_offset", [](const NotedCalibration& c) { return c.time_offset_applied; },
          "added to the times of b [s]")
      .def_property_readonly(
          "notes", [](const NotedCalibration& c) { return c.notes; },
          "what was assumed, repaired or lost while reading, one sentence each")
      .def("__repr__", &in_brackets)
      .def(py::pickle(&state_of, &from_state));
}

}  // namespace

void bind_calibration(py::module_& module) {
  py::class_<NotedCalibration> type(module, "Calibration",
                                    "Everything known about one pair of sensors [m, rad].");
  bind_answer(type);
  bind_details(type);
  const auto define = [&](const char* name, auto function, const char* doc) {
    module.def(name, function, doc, "a"_a, "b"_a, py::kw_only(), "method"_a = "global",
               "plane_a"_a = py::none(), "plane_b"_a = py::none(), "stride"_a = py::none(),
               "weights"_a = "auto", "time_offset"_a = 0.0, "max_gap"_a = PairingOptions{}.max_gap,
               "nominal"_a = py::none());
  };
  define("solve", &solve_trajectories, solve_doc);
  define("solve_quietly", &solve_quietly, "solve() without warnings, for whoever looks at every verdict.");
}

}  // namespace egocal::python
