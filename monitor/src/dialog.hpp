// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/monitor/canvas.hpp"
#include "egocal/monitor/model.hpp"
#include "egocal/monitor/view.hpp"

namespace egocal::monitor {

/// Draws the open dialog, if there is one, in the middle of the screen. A small screen wraps its lines, and
/// help shows only the keys.
void draw_dialog(Canvas& canvas, const PairState* pair, const ViewState& view);

}  // namespace egocal::monitor
