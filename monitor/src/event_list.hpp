// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/monitor/canvas.hpp"
#include "egocal/monitor/model.hpp"
#include "egocal/monitor/text.hpp"

namespace egocal::monitor {

/// panels.cpp: the whole texts of the events, however many rows they take. scroll: rows up from the last one.
void draw_whole_events(const Pane& pane, const Model& model, int scroll, int utc_offset_s, Charset charset);
/// The number of rows that draw_whole_events() has on a screen of this width.
int event_line_count(const Model& model, int width, Charset charset);

}  // namespace egocal::monitor
