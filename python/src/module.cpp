// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "convert.hpp"
#include "egocal/error.hpp"
#include "egocal/version.hpp"

PYBIND11_MODULE(_egocal, module) {
  module.doc() = "egocal: where sensors sit relative to each other, from their motions alone, with proof";
  module.attr("__version__") = egocal::version();
  pybind11::register_exception<egocal::Error>(module, "Error", PyExc_RuntimeError);
  egocal::python::bind_calibration(module);
  egocal::python::bind_statistics(module);
  egocal::python::bind_hand_eye(module);
}
