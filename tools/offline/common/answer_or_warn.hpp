// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/error.hpp"

namespace egocal::tools {

/// What `answer` makes of the request. Where it throws Error, request.unanswered gets the warnings so far.
template <typename Request, typename Result>
Result answer_or_warn(const Request& request, void (*answer)(const Request&, Result&)) {
  Result result;
  try {
    answer(request, result);
  } catch (const Error&) {
    if (request.unanswered) request.unanswered(result.warnings);
    throw;
  }
  return result;
}

}  // namespace egocal::tools
