// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/error.hpp"

namespace egocal {

/// A file of times was given for poses that have times of their own.
class MisplacedTimes : public Error {
 public:
  explicit MisplacedTimes(const Error& error) : Error(error) {}
};

}  // namespace egocal
