// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "figures/frame.hpp"

#include <cmath>

namespace egocal::tools {

namespace {

/// The range of an axis in scaled numbers, with a margin where the data choose it.
AxisRange range_of(const Axis& axis, const AxisRange& data) {
  AxisRange range = data.empty() ? AxisRange{0, 1} : data;
  if (range.most - range.least <= 1e-12 * std::max(std::abs(range.most), 1.0)) {
    range.least -= 0.5;
    range.most += 0.5;
  }
  // a logarithmic axis shows two powers of ten at least: one tick gives no scale
  if (axis.scale == AxisScale::logarithmic && std::floor(range.most) - std::ceil(range.least) < 1) {
    range.least = std::min(range.least, std::floor(range.least + 0.5));
    range.most = std::max(range.most, std::ceil(range.least) + 1);
  }
  const double margin = 0.04 * (range.most - range.least);
  range = {range.least - margin, range.most + margin};
  if (axis.least && drawable(axis, *axis.least)) range.least = on_axis(axis, *axis.least);
  if (axis.most && drawable(axis, *axis.most)) range.most = on_axis(axis, *axis.most);
  return range;
}

}  // namespace

bool drawable(const Axis& axis, double value) {
  return std::isfinite(value) && (axis.scale == AxisScale::linear || value > 0);
}

double on_axis(const Axis& axis, double value) {
  return axis.scale == AxisScale::logarithmic ? std::log10(value) : value;
}

Frame::Frame(const Plot& plot) : plot_(plot) {
  AxisRange data_x, data_y;
  for (const Series& series : plot.series)
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!drawable(plot.x, series.x[i]) || !drawable(plot.y, series.y[i])) continue;
      data_x.include(on_axis(plot.x, series.x[i]));
      data_y.include(on_axis(plot.y, series.y[i]));
      if (series.style == Series::Style::bars) data_y.include(0);
      if (i < series.low.size() && drawable(plot.y, series.low[i]))
        data_y.include(on_axis(plot.y, series.low[i]));
      if (i < series.high.size() && drawable(plot.y, series.high[i]))
        data_y.include(on_axis(plot.y, series.high[i]));
    }
  for (const Marker& marker : plot.markers) {
    const Axis& axis = marker.vertical ? plot.x : plot.y;
    if (drawable(axis, marker.at)) (marker.vertical ? data_x : data_y).include(on_axis(axis, marker.at));
  }
  x_ = range_of(plot.x, data_x);
  y_ = range_of(plot.y, data_y);
  if (plot.equal_axes) make_equal();
}

void Frame::make_equal() {
  const double unit = std::max((x_.most - x_.least) / width(), (y_.most - y_.least) / height());
  const auto widen = [unit](AxisRange& range, double length) {
    const double more = (unit * length - (range.most - range.least)) / 2;
    range = {range.least - more, range.most + more};
  };
  widen(x_, width());
  widen(y_, height());
}

}  // namespace egocal::tools
