// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/printing/trust.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "egocal/bus/diagnosis_json.hpp"
#include "egocal/degrees.hpp"

namespace egocal::tools {

namespace {

/// Three significant digits, and no exponent where a number is large.
std::string rounded(double value) {
  return std::abs(value) < 100 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

std::string verdict_word(Verdict verdict) {
  std::string word(to_string(verdict));
  if (verdict == Verdict::contradictory)
    for (char& letter : word) letter = static_cast<char>(letter - 'a' + 'A');
  return word;
}

}  // namespace

nlohmann::ordered_json trust_json(const Calibration& calibration) {
  nlohmann::ordered_json json;
  json["verdict"] = to_string(calibration.verdict);
  json["reason"] = calibration.reason;
  json["fit"] = bus::fit_json(calibration.fit);
  json["findings"] = bus::findings_json(calibration.findings);
  if (calibration.goal) json["goal"] = bus::goal_json(*calibration.goal);
  return json;
}

std::string fit_in_words(const Fit& fit) {
  if (fit.tenths.empty()) return "";
  return fmt::format(
      "{} deg, {} cm ({} % of the distance) a motion{}; 95 % below {} deg, {} cm; lengths b / a {:.4g}",
      rounded(fit.rotation_median * degrees_per_radian), rounded(100 * fit.translation_median),
      fit.translation_relative_median < 0.995 ? fmt::format("{:.2g}", 100 * fit.translation_relative_median)
                                              : rounded(100 * fit.translation_relative_median),
      fit.motion_seconds > 0 ? fmt::format(" of {:.2g} s", fit.motion_seconds) : "",
      rounded(fit.rotation_95 * degrees_per_radian), rounded(100 * fit.translation_95), fit.length_ratio);
}

std::string trust_text(const Calibration& calibration) {
  std::string text =
      fmt::format("verdict       {}: {}\n", verdict_word(calibration.verdict), calibration.reason);
  for (const Finding& finding : calibration.findings)
    text +=
        fmt::format("{}{}\n              cure: {}\n", finding.certain ? "finding       " : "possible      ",
                    finding.message, finding.remedy);
  if (const std::string fit = fit_in_words(calibration.fit); !fit.empty())
    text += fmt::format("fit           {}\n", fit);
  if (calibration.goal) {
    text += fmt::format("goal          {}\n", goal_in_words(*calibration.goal));
    if (!calibration.goal->next.empty()) text += fmt::format("next          {}\n", calibration.goal->next);
  }
  return text;
}

std::string goal_in_words(const Goal& goal) {
  if (goal.reached) return "reached";
  return fmt::format("missing: {}{}", fmt::join(goal.missing, ", "),
                     goal.seconds_left
                         ? fmt::format("; about {:.0f} s more of this driving", *goal.seconds_left)
                         : "; more of this driving does not help");
}

}  // namespace egocal::tools
