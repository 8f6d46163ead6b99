// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <exception>

#include "convert.hpp"
#include "egocal/error.hpp"
#include "egocal/version.hpp"
#include "python_words.hpp"
#include "warn.hpp"

PYBIND11_MODULE(_egocal, module) {
  module.doc() = "egocal: where sensors sit relative to each other, from their motions alone, with proof";
  module.attr("__version__") = egocal::version();
  static const pybind11::exception<egocal::Error> type(module, "Error", PyExc_RuntimeError);
  pybind11::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const egocal::Error& error) {
      PyErr_SetString(type.ptr(), egocal::python::in_python_words(error.what()).c_str());
    }
  });
  egocal::python::bind_warning(module);
  egocal::python::bind_calibration(module);
  egocal::python::bind_statistics(module);
  egocal::python::bind_hand_eye(module);
}
