// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/monitor/model.hpp"
#include "egocal/monitor/view.hpp"
#include "program.hpp"
#include "source.hpp"

namespace egocal::monitor {

/// Prints what is known, once every pair has an answer, the log ends or the time is over; the exit code.
/// Throws Error where nothing was received.
int run_once(const ProgramOptions& options, Model& model, Source& source, Charset charset);

/// Prints lines, once a second, and events as they come; the exit code. Throws Error where nothing was
/// received.
int run_follow(const ProgramOptions& options, Model& model, Source& source, Charset charset);

/// Prints to standard output. False: the reader has seen enough and has gone. Throws Error where the output
/// cannot be written otherwise.
bool print(const std::string& text);

}  // namespace egocal::monitor
