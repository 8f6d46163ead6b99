// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/monitor/view.hpp"
#include "program.hpp"
#include "source.hpp"

namespace egocal::monitor {

/// What is shown before any key is pressed.
ViewState first_view(const ProgramOptions& options, const Source& source);

/// The offset of the local time from UTC, now [s].
int utc_offset_s();

}  // namespace egocal::monitor
