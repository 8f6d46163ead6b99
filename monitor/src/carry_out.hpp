// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/monitor/model.hpp"
#include "egocal/monitor/view.hpp"
#include "source.hpp"

namespace egocal::monitor {

/// Does what a key asked for: writes the export, or sends the command. The view's notice states the outcome.
void carry_out(const Action& action, const Model& model, ViewState& view, Source& source);

}  // namespace egocal::monitor
