// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "figures/elements.hpp"

#include <fmt/format.h>

namespace egocal::tools {

std::string text_element(double x, double y, const char* anchor, const std::string& content,
                         const std::string& more) {
  return fmt::format("<text x='{:.2f}' y='{:.2f}' text-anchor='{}'{}>{}</text>\n", x, y, anchor, more,
                     escaped(content));
}

std::string line_element(double x1, double y1, double x2, double y2, const char* style) {
  return fmt::format("<line x1='{:.2f}' y1='{:.2f}' x2='{:.2f}' y2='{:.2f}' {}/>\n", x1, y1, x2, y2, style);
}

std::string circle(double x, double y, double radius, const Series& series) {
  const std::string colour = hex(series.colour);
  const std::string paint = series.style == Series::Style::rings
                                ? fmt::format("fill='white' stroke='{}' stroke-width='1.3'", colour)
                                : fmt::format("fill='{}'", colour);
  return fmt::format("<circle cx='{:.2f}' cy='{:.2f}' r='{:g}' {}/>\n", x, y, radius, paint);
}

const char* dashes_of(const Series& series) {
  if (series.style == Series::Style::dashes) return " stroke-dasharray='4 2.5'";
  if (series.style == Series::Style::dotted) return " stroke-dasharray='1 1.6'";
  return "";
}

std::string hex(Colour colour) {
  switch (colour) {
    case Colour::black:
      return "#000000";
    case Colour::blue:
      return "#0072b2";
    case Colour::vermilion:
      return "#d55e00";
    case Colour::green:
      return "#009e73";
    case Colour::orange:
      return "#e69f00";
    case Colour::sky:
      return "#56b4e9";
    case Colour::purple:
      return "#cc79a7";
  }
  return "#000000";
}

std::string escaped(const std::string& content) {
  std::string out;
  for (const char c : content) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '\'':
        out += "&#39;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 && c != '\n' ? '?' : c;
    }
  }
  return out;
}

}  // namespace egocal::tools
