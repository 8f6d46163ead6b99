// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/trust_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>

namespace egocal::tools {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

nlohmann::ordered_json fit_json(const Fit& fit) {
  nlohmann::ordered_json json;
  json["rotation_deg_median"] = fit.rotation_median * degrees;
  json["rotation_deg_95"] = fit.rotation_95 * degrees;
  json["translation_m_median"] = fit.translation_median;
  json["translation_m_95"] = fit.translation_95;
  json["translation_relative_median"] = fit.translation_relative_median;
  json["length_ratio"] = fit.length_ratio;
  json["turning_ratio"] = fit.turning_ratio;
  json["motion_seconds"] = fit.motion_seconds;
  json["tenths"] = nlohmann::ordered_json::array();
  for (const FitTenth& tenth : fit.tenths)
    json["tenths"].push_back({{"begin_s", tenth.begin},
                              {"end_s", tenth.end},
                              {"rotation_deg_median", tenth.rotation_median * degrees},
                              {"translation_m_median", tenth.translation_median},
                              {"translation_relative_median", tenth.translation_relative}});
  return json;
}

nlohmann::ordered_json finding_json(const Finding& finding) {
  nlohmann::ordered_json json;
  json["code"] = finding.code;
  json["certain"] = finding.certain;
  json["message"] = finding.message;
  json["remedy"] = finding.remedy;
  json["improvement"] = finding.improvement;
  if (finding.value) json["value"] = *finding.value;
  if (finding.time) json["time"] = *finding.time;
  if (finding.T_a_b) {
    const Pose& T = *finding.T_a_b;
    json["translation"] = {T.translation.x(), T.translation.y(), T.translation.z()};
    json["rotation_wxyz"] = {T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z()};
  }
  return json;
}

nlohmann::ordered_json goal_json(const Goal& goal) {
  nlohmann::ordered_json json;
  json["reached"] = goal.reached;
  json["missing"] = goal.missing;
  json["seconds_left"] = goal.seconds_left ? nlohmann::ordered_json(*goal.seconds_left) : nullptr;
  json["next"] = goal.next;
  return json;
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
  json["fit"] = fit_json(calibration.fit);
  json["findings"] = nlohmann::ordered_json::array();
  for (const Finding& finding : calibration.findings) json["findings"].push_back(finding_json(finding));
  if (calibration.goal) json["goal"] = goal_json(*calibration.goal);
  return json;
}

std::string trust_text(const Calibration& calibration) {
  std::string text =
      fmt::format("verdict       {}: {}\n", verdict_word(calibration.verdict), calibration.reason);
  for (const Finding& finding : calibration.findings)
    text +=
        fmt::format("{}{}\n              cure: {}\n", finding.certain ? "finding       " : "possible      ",
                    finding.message, finding.remedy);
  const Fit& fit = calibration.fit;
  if (!fit.tenths.empty())
    text += fmt::format(
        "fit           {:.3g} deg, {:.3g} cm ({:.2g} % of the distance) a motion{}; 95 % below {:.3g} deg, "
        "{:.3g} "
        "cm; lengths b / a {:.4g}\n",
        fit.rotation_median * degrees, 100 * fit.translation_median, 100 * fit.translation_relative_median,
        fit.motion_seconds > 0 ? fmt::format(" of {:.2g} s", fit.motion_seconds) : "",
        fit.rotation_95 * degrees, 100 * fit.translation_95, fit.length_ratio);
  if (calibration.goal) {
    const Goal& goal = *calibration.goal;
    text += goal.reached
                ? std::string("goal          reached\n")
                : fmt::format("goal          missing: {}{}\n", fmt::join(goal.missing, ", "),
                              goal.seconds_left
                                  ? fmt::format("; about {:.0f} s more of this driving", *goal.seconds_left)
                                  : "; more of this driving does not help");
    if (!goal.next.empty()) text += fmt::format("next          {}\n", goal.next);
  }
  return text;
}

}  // namespace egocal::tools
