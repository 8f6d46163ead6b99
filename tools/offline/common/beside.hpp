// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace egocal::tools {

/// An egocal::Beside at the same time: the second one in a thread of its own, or before the first where the
/// system gives none. Both are run to their ends; where both throw, what the first one threw is thrown.
void at_the_same_time(const std::function<void()>& first, const std::function<void()>& second);

/// The same without a thread.
void one_after_the_other(const std::function<void()>& first, const std::function<void()>& second);

}  // namespace egocal::tools
