// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "egocal/error.hpp"
#include "egocal/online/nominal_part.hpp"

namespace egocal::tools {

std::vector<double> numbers(const std::string& option, const std::string& text, std::size_t count,
                            char separator) {
  const auto wrong = [&] {
    const std::string expected =
        count == 1 ? "a number" : std::to_string(count) + " numbers separated by '" + separator + "'";
    return UsageError(option + ": expected " + expected + ", got '" + text + "'");
  };
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  while (true) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) throw wrong();
    values.push_back(value);
    if (next == end) break;
    if (*next != separator) throw wrong();
    at = next + 1;
  }
  if (values.size() != count) throw wrong();
  return values;
}

double number_in(const std::string& option, const std::string& text, const Range& range) {
  const double value = numbers(option, text, 1)[0];
  if (range.contains(value)) return value;
  char limits[64];
  std::snprintf(limits, sizeof limits, "%.10g to %.10g", range.least, range.most);
  throw UsageError(option + ": expected " + limits + ", got '" + text + "'");
}

double number(const std::string& option, const std::string& text) {
  return numbers(option, text, 1)[0];
}

namespace {

/// Seven numbers as a pose; what is NaN stays so.
Pose pose_of(const std::string& option, const std::string& text, const std::vector<double>& v) {
  const Eigen::Quaterniond rotation(v[3], v[4], v[5], v[6]);
  if (std::abs(rotation.norm() - 1) > 0.01)
    throw UsageError(option + ": expected a quaternion QW,QX,QY,QZ of length 1, got length " +
                     std::to_string(rotation.norm()));
  for (std::size_t i = 0; i < 3; ++i)
    if (!std::isnan(v[i]) && !plausible_distance(v[i]))
      throw UsageError(option + ": expected X,Y,Z within 1e9 m, got '" + text + "'");
  return {rotation.normalized(), {v[0], v[1], v[2]}};
}

}  // namespace

Pose pose(const std::string& option, const std::string& text) {
  return pose_of(option, text, numbers(option, text, 7));
}

Pose nominal(const std::string& option, const std::string& text) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> v;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string entry = text.substr(at, end - at);
    v.push_back(entry == "nan" ? unknown : number(option, entry));
    at = end + 1;
  }
  if (v.size() == 3) v.resize(7, unknown);
  if (v.size() != 7)
    throw UsageError(option + ": expected X,Y,Z,QW,QX,QY,QZ or X,Y,Z, nan for what is not known, got '" +
                     text + "'");
  const Pose part = pose_of(option, text, v);
  if (const std::string wrong = wrong_with_part(part); !wrong.empty())
    throw UsageError(option + ": " + wrong + ", got '" + text + "'");
  return part;
}

GroundPlane plane(const std::string& option, const std::string& text) {
  const std::vector<double> v = numbers(option, text, 4);
  if (!plausible_distance(v[3]))
    throw UsageError(option + ": expected NX,NY,NZ,D with D within 1e9 m, got '" + text + "'");
  try {
    return validated({{v[0], v[1], v[2]}, v[3]});
  } catch (const Error& error) {
    throw UsageError(option + ": " + error.what());
  }
}

namespace {

/// Whether a weight is within the limits. With less the costs are so small that nothing can be proven of
/// them.
bool weighs_translation(double weight) {
  constexpr double most = limits::translation_weight.most;
  return weight >= 1 / most && weight <= most;
}

}  // namespace

Balance balance(const std::string& option, const std::string& text) {
  const auto wrong = [&](const char* expected) {
    return UsageError(option + ": expected " + expected + ", got '" + text + "'");
  };
  if (text.find(':') == std::string::npos) throw wrong("equal, or R:T of rotation and translation");
  const std::vector<double> v = numbers(option, text, 2, ':');
  if (!limits::rotation_weight.contains(v[0]) || !weighs_translation(v[1]))
    throw wrong("R:T with R from 0 to 1e12 and T from 1e-12 to 1e12");
  return {v[0], v[1]};
}

GoalOptions goal(const std::string& option, const std::string& text) {
  const std::optional<GoalOptions> goal = goal_from_text(text);
  if (!goal)
    throw UsageError(option +
                     ": expected two accuracies above 0 as 0.1deg,2cm (deg or rad; mm, cm or m), got '" +
                     text + "'");
  if (goal->rotation > std::numbers::pi || !plausible_distance(goal->translation))
    throw UsageError(option + ": expected at most 180deg and 1e9m, got '" + text + "'");
  return *goal;
}

}  // namespace egocal::tools
