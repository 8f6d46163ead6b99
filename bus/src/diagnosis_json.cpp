// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/diagnosis_json.hpp"

#include <nlohmann/json.hpp>

#include "egocal/bus/pose_json.hpp"
#include "egocal/degrees.hpp"

namespace egocal::bus {

namespace {

nlohmann::ordered_json finding_json(const Finding& finding) {
  nlohmann::ordered_json json;
  json["code"] = finding.code;
  json["certain"] = finding.certain;
  json["message"] = finding.message;
  json["remedy"] = finding.remedy;
  json["improvement"] = finding.improvement;
  if (finding.value) json["value"] = *finding.value;
  if (finding.time) json["time"] = *finding.time;
  if (finding.T_a_b) put_pose(json, *finding.T_a_b);
  return json;
}

}  // namespace

nlohmann::ordered_json fit_json(const Fit& fit) {
  nlohmann::ordered_json json;
  json["rotation_deg_median"] = fit.rotation_median * degrees_per_radian;
  json["rotation_deg_95"] = fit.rotation_95 * degrees_per_radian;
  json["translation_m_median"] = fit.translation_median;
  json["translation_m_95"] = fit.translation_95;
  json["translation_relative_median"] = fit.translation_relative_median;
  json["length_ratio"] = fit.length_ratio;
  json["turning_ratio"] = fit.turning_ratio;
  json["motion_seconds"] = fit.motion_seconds;
  if (!fit.tenths.empty()) json["tenths"] = nlohmann::ordered_json::array();
  for (const FitTenth& tenth : fit.tenths)
    json["tenths"].push_back({{"begin_s", tenth.begin},
                              {"end_s", tenth.end},
                              {"rotation_deg_median", tenth.rotation_median * degrees_per_radian},
                              {"translation_m_median", tenth.translation_median},
                              {"translation_relative_median", tenth.translation_relative}});
  return json;
}

nlohmann::ordered_json findings_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) json.push_back(finding_json(finding));
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

}  // namespace egocal::bus
