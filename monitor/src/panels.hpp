// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/monitor/canvas.hpp"
#include "egocal/monitor/layout.hpp"
#include "egocal/monitor/view.hpp"

namespace egocal::monitor {

// The panels of the screens. Each fills the pane that the layout gave it.

/// A title with a rule to the right edge.
void draw_title(const Pane& pane, const std::string& title, Charset charset);

// pair_panels.cpp
void draw_pair_card(const Pane& pane, const PairState& pair, Now now, bool selected, bool paused,
                    Charset charset);
// pair_table.cpp
void draw_pair_table(const Pane& pane, const Model& model, int selected, bool header, Charset charset);

void draw_processes(const Pane& pane, const Model& model, bool title, Charset charset);
void draw_events(const Pane& pane, const Model& model, int scroll, int utc_offset_s, Charset charset);

/// stream_panel.cpp: the sensors' streams; all: with what the processes reject, and why.
void draw_streams(const Pane& pane, const Model& model, int scroll, bool all, Charset charset);
/// The number of lines that draw_streams() has with `all`, on a screen of this width.
int stream_line_count(const Model& model, int width);

// detail_panels.cpp
/// verdict_panel.cpp: verdict, findings, goal and fit, a line each.
void draw_verdict(const Pane& pane, const PairState& pair, Charset charset);
void draw_summary(const Pane& pane, const PairState& pair, Charset charset);
void draw_observability(const Pane& pane, const PairState& pair, Charset charset);
void draw_solvers(const Pane& pane, const PairState& pair, Now now, Charset charset);
/// inverted: T_b_a, else T_a_b with its standard deviations.
void draw_direction(const Pane& pane, const PairState& pair, bool inverted, bool matrix, Charset charset);
void draw_curve(const Pane& pane, const PairState& pair, int curve, const ViewState& view);

}  // namespace egocal::monitor
