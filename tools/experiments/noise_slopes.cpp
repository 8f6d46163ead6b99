// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/noise_slopes.hpp"

#include <fmt/format.h>

#include <cmath>

namespace egocal::tools {

namespace {

/// Slope of the least-squares line through (log n, log error).
double slope(const std::vector<double>& sizes, const std::vector<double>& errors) {
  const auto n = static_cast<double>(sizes.size());
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]), y = std::log(errors[i]);
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

/// Mean of the slopes of the runs, and its standard error.
Exponent exponent(const std::vector<const NoisePoint*>& points,
                  std::vector<double> NoisePoint::*errors_of_runs) {
  std::vector<double> sizes, slopes;
  for (const NoisePoint* point : points) sizes.push_back(point->pairs);
  const std::size_t runs = points.empty() ? 0 : (points.front()->*errors_of_runs).size();
  for (std::size_t run = 0; run < runs; ++run) {
    std::vector<double> errors;
    errors.reserve(points.size());
    for (const NoisePoint* point : points) errors.push_back((point->*errors_of_runs)[run]);
    slopes.push_back(slope(sizes, errors));
  }
  const auto n = static_cast<double>(runs);
  Exponent result;
  double squares = 0;
  for (const double one : slopes) result.mean += one / n;
  for (const double one : slopes) squares += (one - result.mean) * (one - result.mean);
  result.standard_error = runs > 1 ? std::sqrt(squares / (n * (n - 1))) : 0;
  return result;
}

/// The part in percent, without a negative zero.
double percent(double part) {
  return std::round(1000 * part) / 10 + 0.0;
}

}  // namespace

std::vector<NoiseSlope> slopes(const std::vector<NoisePoint>& points) {
  constexpr int least_pairs = 100;  // below, single motions decide
  std::vector<NoiseSlope> result;
  std::vector<double> levels;
  for (const NoisePoint& point : points)
    if (levels.empty() || levels.back() != point.level) levels.push_back(point.level);
  for (const double level : levels) {
    std::vector<const NoisePoint*> sizes;
    for (const int least : {least_pairs, 0}) {
      if (sizes.size() >= 3) break;
      sizes.clear();
      for (const NoisePoint& point : points)
        if (point.level == level && point.pairs > least) sizes.push_back(&point);
    }
    result.push_back({level, exponent(sizes, &NoisePoint::translations),
                      exponent(sizes, &NoisePoint::rotations),
                      exponent(sizes, &NoisePoint::corrected_translations),
                      exponent(sizes, &NoisePoint::translation_deviations),
                      exponent(sizes, &NoisePoint::rotation_deviations), sizes.back()->shortened});
  }
  return result;
}

std::string markdown(const std::vector<NoiseSlope>& slopes) {
  std::string text =
      "| noise | translation error | the same, noise taken off | rotation error | its spread: translation | "
      "rotation | translation too short by |\n| --- | --- | --- | --- | --- | --- | --- |\n";
  const auto cell = [](const Exponent& e) {
    return fmt::format("{:.2f} +- {:.2f}", e.mean, e.standard_error);
  };
  for (const NoiseSlope& s : slopes)
    text += fmt::format("| {:g} % | {} | {} | {} | {} | {} | {:.1f} % |\n", 100 * s.level,
                        cell(s.translation), cell(s.corrected_translation), cell(s.rotation),
                        cell(s.translation_spread), cell(s.rotation_spread), percent(s.shortened));
  return text;
}

std::string html(const std::vector<NoiseSlope>& slopes) {
  std::string text =
      "<table>\n<tr><th>noise</th><th>translation error</th><th>the same, noise taken off</th><th>rotation "
      "error</th><th>its spread: translation</th><th>rotation</th><th>translation too short by</th></tr>\n";
  const auto cell = [](const Exponent& e) {
    return fmt::format("n<sup>{:.2f} &plusmn; {:.2f}</sup>", e.mean, e.standard_error);
  };
  for (const NoiseSlope& s : slopes)
    text += fmt::format(
        "<tr><td>{:g} %</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.1f} "
        "%</td></tr>\n",
        100 * s.level, cell(s.translation), cell(s.corrected_translation), cell(s.rotation),
        cell(s.translation_spread), cell(s.rotation_spread), percent(s.shortened));
  return text + "</table>\n";
}

}  // namespace egocal::tools
