// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/online/answer.hpp"

namespace egocal {

std::string_view to_string(Method method) {
  switch (method) {
    case Method::dual:
      return "dual";
    case Method::sdp:
      return "sdp";
    case Method::sqp:
      return "sqp";
    case Method::slsqp:
      return "slsqp";
  }
  return "unknown";
}

std::optional<Method> method_from_name(std::string_view text) {
  if (text == "global") return Method::dual;
  if (text == "fast") return Method::sqp;
  for (const Method method : {Method::dual, Method::sdp, Method::sqp, Method::slsqp})
    if (text == to_string(method)) return method;
  return std::nullopt;
}

}  // namespace egocal
