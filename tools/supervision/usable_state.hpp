// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::tools {

/// Throws Error, in the words of the process of this name, where it could not continue from this file or keep
/// its state there: the file is something else, another process holds it, or it cannot be held. Nothing is
/// changed, and nothing remains. A state that the process would refuse and keep aside is usable.
void require_usable_state(const std::string& file, const std::string& process);

}  // namespace egocal::tools
