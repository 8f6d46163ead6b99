// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "warn.hpp"

#include "egocal/diagnosis/certain_of_either.hpp"
#include "python_words.hpp"

namespace egocal::python {

namespace py = pybind11;

void bind_warning(py::module_& module) {
  // pickled by the name under which people know it
  PyObject* const category = PyErr_NewExceptionWithDoc(
      "egocal.EgocalWarning", "An answer that is not good, or data that were repaired or lost.",
      PyExc_UserWarning, nullptr);
  if (!category) throw py::error_already_set();
  module.attr("EgocalWarning") = py::reinterpret_steal<py::object>(category);
}

void warn(const std::string& text) {
  const py::object category = py::module_::import("egocal._egocal").attr("EgocalWarning");
  // level 2: the caller of the function of egocal/__init__.py, as functions of C++ have no frame
  if (PyErr_WarnEx(category.ptr(), text.c_str(), 2) != 0) throw py::error_already_set();
}

void warn_of(const Calibration& calibration, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) warn(note);
  if (calibration.verdict != Verdict::good)
    warn(std::string(to_string(calibration.verdict)) + ": " + in_python_words(calibration.reason));
  else
    for (const Finding& finding : calibration.findings)
      if (certain_of_either(finding))
        warn("good, but: " + in_python_words(finding.message + " " + finding.remedy));
}

}  // namespace egocal::python
