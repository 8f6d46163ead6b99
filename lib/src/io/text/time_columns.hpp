// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/text/first_lines.hpp"
#include "io/text/layout.hpp"

namespace egocal::detail {

/// The unit of the times, by the header or by their size; of matrices, whether the first column holds times.
void set_time_unit(TextLayout& layout, const Sniffed& sniffed);

/// A column without a known name whose values increase from row to row may hold the times. Numbers of rows do
/// as well, by one.
void note_likely_times(TextLayout& layout, const Sniffed& sniffed);

}  // namespace egocal::detail
