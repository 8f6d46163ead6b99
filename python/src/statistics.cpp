// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <cmath>
#include <string>

#include "convert.hpp"
#include "egocal/certificate/certificate.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/solvers/global.hpp"
#include "warn.hpp"

namespace egocal::python {

namespace {

using namespace pybind11::literals;

double to_weight(const py::object& object, const char* name) {
  constexpr const char* expected = "a finite number, 0 or more";
  const double weight = to_number(object, name, expected);
  if (!(weight >= 0) || !std::isfinite(weight))
    throw py::value_error(std::string(name) + ": expected " + expected);
  return weight;
}

/// The matrix of an object, which must be finite and symmetric as a cost matrix always is; without that there
/// is no minimum to be found.
Matrix8d to_cost_matrix(const py::object& object) {
  const Matrix8d Q = to_matrix8(object, "Q");
  constexpr double rounding = 1e-9;  // of sums in another order
  if (!Q.allFinite()) throw py::value_error("Q: expected finite numbers");
  if (!((Q - Q.transpose()).cwiseAbs().maxCoeff() <= rounding * Q.cwiseAbs().maxCoeff()))
    throw py::value_error("Q: expected a symmetric matrix");
  return Q;
}

/// Warns where no answer was found: an identity that nothing was found for looks like an answer.
void warn_of_status(SolverStatus status, const Matrix8d& Q) {
  if (status == SolverStatus::iteration_limit)
    warn("solve_dual: not converged: the best point that was found; verify() tells what it is worth");
  else if (status != SolverStatus::converged)
    warn("solve_dual: degenerate: Q shows no motion, and what is returned is no answer");
  else if (!(Q.bottomRightCorner<4, 4>().trace() > 0))  // (14): the translation is weighed by it alone
    warn(
        "solve_dual: Q shows no translation (its weight is 0, or nothing turned): the one returned is no "
        "answer");
}

py::dict verified(const py::object& cost, const py::object& T_a_b) {
  const Matrix8d Q = to_cost_matrix(cost);
  const Certificate certificate = verify(Q, to_dual_quaternion(to_pose(to_matrix4(T_a_b, "T_a_b"), "T_a_b")));
  return py::dict("certified"_a = certificate.optimality == Optimality::certified,
                  "cost"_a = certificate.cost, "lower_bound"_a = certificate.lower_bound,
                  "gap"_a = certificate.gap, "rounding"_a = certificate.rounding,
                  "reach_translation"_a = certificate.reach_translation,
                  "reach_rotation"_a = certificate.reach_rotation);
}

}  // namespace

void bind_statistics(py::module_& module) {
  py::class_<Statistics>(module, "Statistics",
                         "36 numbers, the whole memory of any number of motion pairs. They add up.")
      .def(py::init<>())
      .def(
          "add",
          [](Statistics& statistics, const py::object& motion_a, const py::object& motion_b,
             const py::object& weight) {
            const double weight_of_pair = to_weight(weight, "weight");
            statistics.add(to_dual_quaternion(to_pose(to_matrix4(motion_a, "motion_a"), "motion_a")),
                           to_dual_quaternion(to_pose(to_matrix4(motion_b, "motion_b"), "motion_b")),
                           weight_of_pair);
          },
          "Adds one pair of motions over the same time, (4, 4) each: the later pose in the earlier one.",
          "motion_a"_a, "motion_b"_a, "weight"_a = 1.0)
      .def(
          "__iadd__", [](Statistics& self, const Statistics& other) -> Statistics& { return self += other; },
          py::is_operator())
      .def(
          "__add__", [](Statistics self, const Statistics& other) { return self += other; },
          py::is_operator())
      .def("__len__", [](const Statistics& statistics) { return statistics.count; })
      .def(
          "cost_matrix",
          [](const Statistics& statistics, const py::object& rotation,
             const py::object& translation) -> Eigen::Matrix<double, 8, 8> {
            const Balance balance{to_weight(rotation, "rotation"), to_weight(translation, "translation")};
            return cost_matrix(statistics, balance);
          },
          "(8, 8): Q of (16)", "rotation"_a = 1.0, "translation"_a = 1.0)
      .def(py::pickle(
          [](const Statistics& s) {
            return py::make_tuple(Eigen::Matrix<double, 8, 8>(s.dual_rows), s.weight, s.count);
          },
          [](const py::tuple& state) {
            if (state.size() != 3) throw py::value_error("Statistics: not a pickled one");
            Statistics statistics;
            statistics.dual_rows = state[0].cast<Eigen::Matrix<double, 8, 8>>();
            statistics.weight = state[1].cast<double>();
            statistics.count = state[2].cast<std::uint64_t>();
            return statistics;
          }));

  module.def(
      "solve_dual",
      [](const py::object& cost) {
        const Matrix8d Q = to_cost_matrix(cost);
        const Solution solution = solve_dual(Q);
        warn_of_status(solution.status, Q);
        return to_matrix(egocal::to_pose(solution.q));
      },
      "(4, 4): the global minimum of (18) for the cost matrix Q (8, 8). verify() proves it. An EgocalWarning "
      "is given where Q shows no extrinsic; the identity is returned then.",
      "Q"_a);
  module.def("verify", &verified,
             "Whether T_a_b (4, 4), wherever it comes from, is the global minimum for Q (8, 8): a dict of\n"
             "certified, cost, lower_bound, gap, rounding, reach_translation [m], reach_rotation [rad].",
             "Q"_a, "T_a_b"_a);
}

}  // namespace egocal::python
