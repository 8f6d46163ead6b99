// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "io/text/first_lines.hpp"
#include "io/text/layout.hpp"

namespace egocal::detail {

/// A table whose columns have names, from the option or a header; false: they have none. Throws Error where
/// the names make no pose, or one of them counts twice.
bool set_named(TextLayout& layout, const Sniffed& sniffed, const ReadOptions& options,
               const std::string& file);

/// Whether a quantity is in the column at `index`.
bool is_read(const TextLayout& layout, std::size_t index);

}  // namespace egocal::detail
