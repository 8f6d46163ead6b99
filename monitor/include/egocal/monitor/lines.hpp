// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/monitor/model.hpp"
#include "egocal/monitor/text.hpp"

namespace egocal::monitor {

// The model as text, without a terminal: for pipes, logs and bug reports.

/// A line per pair.
std::string pair_lines(const Model& model, Charset charset);
/// A line per pair, then a line per process.
std::string text_lines(const Model& model, Charset charset);
/// "12:34:56 lidar -> camera: certified ...": an event as a line.
std::string event_line(const Event& event, int utc_offset_s);
/// One JSON object on one line: pairs, processes, events. SI units; what is not finite is null.
std::string json_line(const Model& model);

}  // namespace egocal::monitor
