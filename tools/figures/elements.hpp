// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Elements of SVG.
#pragma once

#include <string>

#include "figures/plot.hpp"

namespace egocal::tools {

/// anchor: "start", "middle" or "end". more: further attributes, each after a space. content is escaped().
std::string text_element(double x, double y, const char* anchor, const std::string& content,
                         const std::string& more = "");
/// style: attributes.
std::string line_element(double x1, double y1, double x2, double y2, const char* style);
/// A point of a series: a ring or a dot in its colour.
std::string circle(double x, double y, double radius, const Series& series);
/// The attribute of a line's pattern, after a space; empty: none.
const char* dashes_of(const Series& series);

}  // namespace egocal::tools
