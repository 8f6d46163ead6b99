// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace egocal {

/// Does two things that do not depend on each other, one after the other or at the same time, and returns
/// when both are done. The library starts no thread; a program may hand in one of these that does. What
/// either throws is thrown, that of the first where both do.
using Beside = std::function<void(const std::function<void()>& first, const std::function<void()>& second)>;

}  // namespace egocal
