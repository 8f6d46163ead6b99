// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "findings.hpp"

#include <pybind11/stl.h>

#include <array>
#include <string>

#include "python_words.hpp"

namespace egocal::python {

namespace py = pybind11;

namespace {

using namespace pybind11::literals;

py::dict dict_of(const Finding& finding) {
  py::dict dict("code"_a = finding.code, "certain"_a = finding.certain,
                "message"_a = in_python_words(finding.message), "remedy"_a = in_python_words(finding.remedy),
                "improvement"_a = finding.improvement);
  if (finding.value) dict["value"] = *finding.value;
  if (finding.time) dict["time"] = *finding.time;
  if (finding.T_a_b) {
    const Eigen::Vector3d& t = finding.T_a_b->translation;
    const Eigen::Quaterniond& q = finding.T_a_b->rotation;
    dict["translation"] = std::array{t.x(), t.y(), t.z()};
    dict["rotation_wxyz"] = std::array{q.w(), q.x(), q.y(), q.z()};
  }
  return dict;
}

Finding finding_from(const py::tuple& state) {
  Finding finding;
  finding.code = state[0].cast<std::string>();
  finding.certain = state[1].cast<bool>();
  finding.message = state[2].cast<std::string>();
  finding.remedy = state[3].cast<std::string>();
  finding.improvement = state[4].cast<double>();
  finding.value = state[5].cast<std::optional<double>>();
  finding.time = state[6].cast<std::optional<double>>();
  if (!state[7].is_none()) finding.T_a_b = pose_of(state[7]);
  return finding;
}

}  // namespace

py::tuple numbers_of(const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return py::make_tuple(t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z());
}

Pose pose_of(const py::handle& numbers) {
  const auto x = numbers.cast<std::array<double, 7>>();
  return {Eigen::Quaterniond(x[3], x[4], x[5], x[6]), {x[0], x[1], x[2]}};
}

py::list findings_of(const std::vector<Finding>& findings) {
  py::list list;
  for (const Finding& finding : findings) list.append(dict_of(finding));
  return list;
}

py::list states_of(const std::vector<Finding>& findings) {
  py::list list;
  for (const Finding& finding : findings)
    list.append(py::make_tuple(finding.code, finding.certain, finding.message, finding.remedy,
                               finding.improvement, finding.value, finding.time,
                               finding.T_a_b ? py::object(numbers_of(*finding.T_a_b)) : py::none()));
  return list;
}

std::vector<Finding> findings_from(const py::handle& states) {
  std::vector<Finding> findings;
  for (const py::handle state : states.cast<py::list>())
    findings.push_back(finding_from(state.cast<py::tuple>()));
  return findings;
}

}  // namespace egocal::python
