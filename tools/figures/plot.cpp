// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "figures/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace egocal::tools {

namespace {

constexpr double font_size = 8;                                // [pt], the size of the paper's captions
constexpr double left = 44, right = 8, top = 20, bottom = 32;  // margins [pt]

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void include(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  bool empty() const { return !(least <= most); }
};

bool drawable(const Axis& axis, double value) {
  return std::isfinite(value) && (axis.scale == AxisScale::linear || value > 0);
}

double scaled(const Axis& axis, double value) {
  return axis.scale == AxisScale::logarithmic ? std::log10(value) : value;
}

/// The range of an axis in scaled numbers, with a margin where the data choose it.
Range range_of(const Axis& axis, const Range& data) {
  Range range = data.empty() ? Range{0, 1} : data;
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
  if (axis.least && drawable(axis, *axis.least)) range.least = scaled(axis, *axis.least);
  if (axis.most && drawable(axis, *axis.most)) range.most = scaled(axis, *axis.most);
  return range;
}

/// From data to points of the picture.
class Frame {
 public:
  explicit Frame(const Plot& plot) : plot_(plot) {
    Range data_x, data_y;
    for (const Series& series : plot.series)
      for (std::size_t i = 0; i < series.x.size(); ++i) {
        if (!drawable(plot.x, series.x[i]) || !drawable(plot.y, series.y[i])) continue;
        data_x.include(scaled(plot.x, series.x[i]));
        data_y.include(scaled(plot.y, series.y[i]));
        if (series.style == Series::Style::bars) data_y.include(0);
        if (i < series.low.size() && drawable(plot.y, series.low[i]))
          data_y.include(scaled(plot.y, series.low[i]));
        if (i < series.high.size() && drawable(plot.y, series.high[i]))
          data_y.include(scaled(plot.y, series.high[i]));
      }
    for (const Marker& marker : plot.markers) {
      const Axis& axis = marker.vertical ? plot.x : plot.y;
      if (drawable(axis, marker.at)) (marker.vertical ? data_x : data_y).include(scaled(axis, marker.at));
    }
    x_ = range_of(plot.x, data_x);
    y_ = range_of(plot.y, data_y);
    if (plot.equal_axes) make_equal();
  }

  double width() const { return plot_.width - left - right; }
  double height() const { return plot_.height - top - bottom; }
  const Range& x_range() const { return x_; }
  const Range& y_range() const { return y_; }
  double x(double value) const {
    return left + width() * (scaled(plot_.x, value) - x_.least) / (x_.most - x_.least);
  }
  double y(double value) const {
    return top + height() * (1 - (scaled(plot_.y, value) - y_.least) / (y_.most - y_.least));
  }

 private:
  void make_equal() {
    const double unit = std::max((x_.most - x_.least) / width(), (y_.most - y_.least) / height());
    const auto widen = [unit](Range& range, double length) {
      const double more = (unit * length - (range.most - range.least)) / 2;
      range = {range.least - more, range.most + more};
    };
    widen(x_, width());
    widen(y_, height());
  }

  const Plot& plot_;
  Range x_, y_;
};

std::string text(double x, double y, const char* anchor, const std::string& content,
                 const std::string& more = "") {
  return fmt::format("<text x='{:.2f}' y='{:.2f}' text-anchor='{}'{}>{}</text>\n", x, y, anchor, more,
                     escaped(content));
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return fmt::format("<line x1='{:.2f}' y1='{:.2f}' x2='{:.2f}' y2='{:.2f}' {}/>\n", x1, y1, x2, y2, style);
}

constexpr const char* grid_style = "stroke='#d9d9d9' stroke-width='0.5'";

/// Tick positions in data units.
std::vector<double> ticks_of(const Axis& axis, const Range& range, int wanted) {
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

std::string axes(const Plot& plot, const Frame& frame) {
  std::string out;
  const double base = top + frame.height();
  for (const double tick : ticks_of(plot.x, frame.x_range(), 6)) {
    const double x = frame.x(tick);
    out += line(x, top, x, base, grid_style) + text(x, base + font_size + 3, "middle", tick_label(tick));
  }
  for (const double tick : ticks_of(plot.y, frame.y_range(), 5)) {
    const double y = frame.y(tick);
    out += line(left, y, left + frame.width(), y, grid_style) +
           text(left - 3, y + font_size / 3, "end", tick_label(tick));
  }
  out += fmt::format(
      "<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='none' stroke='#404040' "
      "stroke-width='0.6'/>\n",
      left, top, frame.width(), frame.height());
  out += text(left + frame.width() / 2, plot.height - 6, "middle", plot.x.label);
  out += text(0, 0, "middle", plot.y.label,
              fmt::format(" transform='translate(9,{:.2f}) rotate(-90)'", top + frame.height() / 2));
  out += text(left + frame.width() / 2, 12, "middle", plot.title, " font-weight='bold'");
  return out;
}

std::string band(const Series& series, const Plot& plot, const Frame& frame) {
  if (series.low.size() != series.x.size() || series.high.size() != series.x.size()) return "";
  std::string upper, lower;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!drawable(plot.x, series.x[i]) || !drawable(plot.y, series.low[i]) ||
        !drawable(plot.y, series.high[i]))
      continue;
    upper += fmt::format("{:.2f},{:.2f} ", frame.x(series.x[i]), frame.y(series.high[i]));
    lower = fmt::format("{:.2f},{:.2f} ", frame.x(series.x[i]), frame.y(series.low[i])) + lower;
  }
  return fmt::format("<polygon points='{}{}' fill='{}' fill-opacity='0.18'/>\n", upper, lower,
                     hex(series.colour));
}

/// The attribute of a line's pattern.
const char* dashes_of(const Series& series) {
  if (series.style == Series::Style::dashes) return " stroke-dasharray='4 2.5'";
  if (series.style == Series::Style::dotted) return " stroke-dasharray='1 1.6'";
  return "";
}

std::string circle(double x, double y, double radius, const Series& series) {
  const std::string colour = hex(series.colour);
  const std::string paint = series.style == Series::Style::rings
                                ? fmt::format("fill='white' stroke='{}' stroke-width='1.3'", colour)
                                : fmt::format("fill='{}'", colour);
  return fmt::format("<circle cx='{:.2f}' cy='{:.2f}' r='{:g}' {}/>\n", x, y, radius, paint);
}

std::string polyline(const std::string& points, const Series& series) {
  if (points.empty()) return "";
  const char* dashes = dashes_of(series);
  return fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='1.1'{}/>\n", points,
                     hex(series.colour), dashes);
}

std::string lines(const Series& series, const Plot& plot, const Frame& frame) {
  std::string out;
  std::vector<Point> points;
  const auto draw = [&] {
    std::string text;
    for (const Point& point : thinned_line(points, plot.thinning))
      text += fmt::format("{:.2f},{:.2f} ", point.x, point.y);
    out += polyline(text, series);
    points.clear();
  };
  for (std::size_t i = 0; i < series.x.size(); ++i)
    if (drawable(plot.x, series.x[i]) && drawable(plot.y, series.y[i]))
      points.push_back({frame.x(series.x[i]), frame.y(series.y[i])});
    else
      draw();
  draw();
  return out;
}

/// Round caps of lines without a length: a third of the bytes of circles.
std::string many_dots(const std::vector<Point>& points, const Series& series) {
  std::string path;
  for (const Point& point : points) path += fmt::format("M{:.2f},{:.2f}h0", point.x, point.y);
  return fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='{:g}' stroke-linecap='round'/>\n",
                     path, hex(series.colour), 2 * series.radius);
}

std::string dots(const Series& series, const Plot& plot, const Frame& frame) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < series.x.size(); ++i)
    if (drawable(plot.x, series.x[i]) && drawable(plot.y, series.y[i]))
      points.push_back({frame.x(series.x[i]), frame.y(series.y[i])});
  if (series.style == Series::Style::points && points.size() >= plot.thinning.least_points) {
    std::erase_if(points, [&](const Point& point) {
      return !(point.x >= 0 && point.x <= plot.width && point.y >= 0 && point.y <= plot.height);
    });
    return many_dots(thinned_dots(points, series.radius, plot.thinning), series);
  }
  std::string out;
  for (const Point& point : points) out += circle(point.x, point.y, series.radius, series);
  return out;
}

std::string bars(const Series& series, const Plot& plot, const Frame& frame) {
  if (series.x.empty()) return "";
  const double step = series.x.size() > 1 ? frame.x(series.x[1]) - frame.x(series.x[0]) : frame.width() / 2;
  const double base = top + frame.height();
  std::string out;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!drawable(plot.y, series.y[i])) continue;
    const double y = frame.y(series.y[i]);
    out += fmt::format("<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='{}'/>\n",
                       frame.x(series.x[i]) - 0.45 * step, y, 0.9 * step, std::max(0.0, base - y),
                       hex(series.colour));
  }
  return out;
}

std::string drawn(const Series& series, const Plot& plot, const Frame& frame) {
  switch (series.style) {
    case Series::Style::points:
    case Series::Style::rings:
      return dots(series, plot, frame);
    case Series::Style::bars:
      return bars(series, plot, frame);
    case Series::Style::line:
    case Series::Style::dashes:
    case Series::Style::dotted:
      break;
  }
  return band(series, plot, frame) + lines(series, plot, frame);
}

std::string drawn(const Marker& marker, const Frame& frame) {
  constexpr const char* style = "stroke='#404040' stroke-width='0.8' stroke-dasharray='2 2'";
  if (marker.vertical) {
    const double x = frame.x(marker.at);
    return line(x, top, x, top + frame.height(), style) +
           text(x + 2, top + font_size + 1, "start", marker.label);
  }
  const double y = frame.y(marker.at);
  const double label = y - 2 - font_size > top ? y - 2 : y + font_size;
  return line(left, y, left + frame.width(), y, style) +
         text(left + frame.width() - 2, label, "end", marker.label);
}

constexpr double letter_width = 0.56 * font_size;  // of Helvetica, on average

/// A place for the legend: its upper left corner.
struct Place {
  double x = 0, y = 0;
};

/// Whether a legend there would hide the label of a vertical marker, which is at the top.
bool hides_a_label(const Plot& plot, const Frame& frame, const Place& corner, double width) {
  if (corner.y > top + 2 * font_size) return false;
  for (const Marker& marker : plot.markers) {
    const double from = frame.x(marker.at),
                 to = from + letter_width * static_cast<double>(marker.label.size());
    if (marker.vertical && from < corner.x + width && to > corner.x) return true;
  }
  return false;
}

/// The corner that hides the fewest points of the data, and no label where that can be.
Place emptiest_corner(const Plot& plot, const Frame& frame, double width, double height) {
  constexpr double gap = 3;  // [pt]
  const double far_x = left + frame.width() - width - gap, far_y = top + frame.height() - height - gap;
  const Place corners[] = {{far_x, top + gap}, {left + gap, top + gap}, {far_x, far_y}, {left + gap, far_y}};
  Place best = corners[0];
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (const Place& corner : corners) {
    constexpr std::size_t label = 20;  // as bad as hiding this many points
    std::size_t hidden = hides_a_label(plot, frame, corner, width) ? label : 0;
    for (const Series& series : plot.series)
      for (std::size_t i = 0; i < series.x.size(); ++i) {
        if (!drawable(plot.x, series.x[i]) || !drawable(plot.y, series.y[i])) continue;
        const double x = frame.x(series.x[i]) - corner.x, y = frame.y(series.y[i]) - corner.y;
        hidden += x >= 0 && x <= width && y >= 0 && y <= height;
      }
    if (hidden >= fewest) continue;
    fewest = hidden;
    best = corner;
  }
  return best;
}

std::string legend(const Plot& plot, const Frame& frame) {
  constexpr double line_height = font_size + 2, sample = 14;  // [pt]
  std::size_t rows = 0, longest = 0;
  for (const Series& series : plot.series) {
    rows += !series.name.empty();
    longest = std::max(longest, series.name.size());
  }
  if (rows == 0) return "";
  const double width = sample + 8 + letter_width * static_cast<double>(longest);
  const double height = line_height * static_cast<double>(rows) + 2;
  const Place place = emptiest_corner(plot, frame, width, height);
  std::string out = fmt::format(
      "<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='white' fill-opacity='0.8'/>\n",
      place.x, place.y, width, height);
  double y = place.y + font_size;
  for (const Series& series : plot.series) {
    if (series.name.empty()) continue;
    const char* dashes = dashes_of(series);
    if (series.style == Series::Style::points || series.style == Series::Style::rings)
      out += circle(place.x + 2 + sample / 2, y - 3, std::max(2.0, series.radius), series);
    else
      out += fmt::format(
          "<line x1='{:.2f}' y1='{:.2f}' x2='{:.2f}' y2='{:.2f}' stroke='{}' stroke-width='2'{}/>\n",
          place.x + 2, y - 3, place.x + 2 + sample, y - 3, hex(series.colour), dashes);
    out += text(place.x + sample + 6, y, "start", series.name);
    y += line_height;
  }
  return out;
}

}  // namespace

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

Series histogram(const std::vector<double>& values, int bins, Colour colour) {
  Series series;
  series.style = Series::Style::bars;
  series.colour = colour;
  Range range;
  for (const double value : values)
    if (std::isfinite(value)) range.include(value);
  if (range.empty() || bins < 1) return series;
  const double width = std::max((range.most - range.least) / bins, 1e-300);
  for (int i = 0; i < bins; ++i) {
    series.x.push_back(range.least + (i + 0.5) * width);
    series.y.push_back(0);
  }
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const int bin = std::min(bins - 1, static_cast<int>((value - range.least) / width));
    series.y[static_cast<std::size_t>(bin)] += 1;
  }
  return series;
}

std::string svg(const Plot& plot) {
  const Frame frame(plot);
  std::string out = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:g} {1:g}' width='{0:g}pt' height='{1:g}pt' "
      "font-family='Helvetica, Arial, sans-serif' font-size='{2:g}' role='img' aria-label='{3}'>\n"
      "<rect width='100%' height='100%' fill='white'/>\n",
      plot.width, plot.height, font_size, escaped(plot.title));
  out += axes(plot, frame);
  // pictures of one page share their identifiers: equal sizes have equal clips
  const std::string clip = fmt::format("clip-{:g}-{:g}", plot.width, plot.height);
  out += fmt::format(
      "<clipPath id='{}'><rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}'/></clipPath>\n", clip,
      left, top, frame.width(), frame.height());
  out += fmt::format("<g clip-path='url(#{})'>\n", clip);
  for (const Series& series : plot.series) out += drawn(series, plot, frame);
  for (const Marker& marker : plot.markers) out += drawn(marker, frame);
  return out + "</g>\n" + legend(plot, frame) + "</svg>\n";
}

}  // namespace egocal::tools
