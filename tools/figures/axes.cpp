// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "figures/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/elements.hpp"

namespace egocal::tools {

namespace {

constexpr const char* grid_style = "stroke='#d9d9d9' stroke-width='0.5'";

/// Tick positions in data units.
std::vector<double> ticks_of(const Axis& axis, const AxisRange& range, int wanted) {
  if (axis.scale == AxisScale::linear) return linear_ticks(range.least, range.most, wanted);
  std::vector<double> ticks;
  const int step = std::max(1, static_cast<int>(std::ceil((range.most - range.least) / wanted)));
  for (int power = static_cast<int>(std::ceil(range.least)); power <= range.most; power += step)
    ticks.push_back(std::pow(10.0, power));
  return ticks;
}

std::string tick_label(double value) {
  return fmt::format("{:.6g}", std::abs(value) < 1e-12 ? 0.0 : value);
}

}  // namespace

std::string axes(const Plot& plot, const Frame& frame) {
  std::string out;
  const double base = margin_top + frame.height();
  for (const double tick : ticks_of(plot.x, frame.x_range(), 6)) {
    const double x = frame.x(tick);
    out += line_element(x, margin_top, x, base, grid_style) +
           text_element(x, base + font_size + 3, "middle", tick_label(tick));
  }
  for (const double tick : ticks_of(plot.y, frame.y_range(), 5)) {
    const double y = frame.y(tick);
    out += line_element(margin_left, y, margin_left + frame.width(), y, grid_style) +
           text_element(margin_left - 3, y + font_size / 3, "end", tick_label(tick));
  }
  out += fmt::format(
      "<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='none' stroke='#404040' "
      "stroke-width='0.6'/>\n",
      margin_left, margin_top, frame.width(), frame.height());
  out += text_element(margin_left + frame.width() / 2, plot.height - 6, "middle", plot.x.label);
  out += text_element(
      0, 0, "middle", plot.y.label,
      fmt::format(" transform='translate(9,{:.2f}) rotate(-90)'", margin_top + frame.height() / 2));
  out += text_element(margin_left + frame.width() / 2, 12, "middle", plot.title, " font-weight='bold'");
  return out;
}

std::vector<double> linear_ticks(double least, double most, int wanted) {
  if (!(most > least) || !std::isfinite(most - least)) return {};
  const double rough = (most - least) / std::max(1, wanted);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double part = rough / power;
  const double step = power * (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10);
  std::vector<double> ticks;
  for (double n = std::ceil(least / step); n * step <= most && ticks.size() < 100; ++n)
    ticks.push_back(n * step);
  return ticks;
}

}  // namespace egocal::tools
