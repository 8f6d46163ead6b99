// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace egocal {

/// The one exception of this project: bad input from outside. Its message is one line that names file, line
/// and field where there are any, and what was expected. Solvers never throw on hard data: they return a
/// status.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An error with the message "drive.tum:12: field 3 (ty): expected a number, got 'abc'". line < 1 and empty
/// parts are omitted.
Error error_at(const std::string& file, long line, const std::string& field, const std::string& problem);

}  // namespace egocal
