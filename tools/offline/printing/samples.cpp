// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/printing/samples.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <string>
#include <vector>

#include "egocal/bus/pose_json.hpp"
#include "egocal/degrees.hpp"
#include "offline/pair/samples.hpp"

namespace egocal::tools {

namespace {

/// Rows of the file of a, counted from 1.
std::vector<std::size_t> wrong_rows(const SolveResult& result) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < result.samples->residuals.size(); ++i)
    if (result.samples->residuals[i].wrong) rows.push_back(result.matched.rows_a[i] + 1);
  return rows;
}

const char* target_name(const SolveResult& result) {
  return result.eye_to_hand ? "target in the hand" : "target in the base";
}

}  // namespace

nlohmann::ordered_json samples_json(const SolveResult& result) {
  const SampleCalibration& samples = *result.samples;
  nlohmann::ordered_json json;
  json["count"] = samples.residuals.size();
  json["wrong"] = wrong_rows(result);
  json["setup"] = result.eye_to_hand ? "eye_to_hand" : "eye_in_hand";
  json["matched_by"] = result.matched.by_stamp ? "stamp" : "row";
  json["without_partner"] = result.matched.without_partner;
  json["target"] = bus::pose_json(samples.T_world_a_world_b);
  json["spread_mm"] = {{"median", 1e3 * samples.spread_median},
                       {"rms", 1e3 * samples.spread_rms},
                       {"largest", 1e3 * samples.spread_largest}};
  json["noise"] = {{"rotation_deg", samples.noise_rotation * degrees_per_radian},
                   {"translation_mm", 1e3 * samples.noise_translation}};
  json["residuals"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < samples.residuals.size(); ++i) {
    const SampleResidual& residual = samples.residuals[i];
    json["residuals"].push_back({{"row", result.matched.rows_a[i] + 1},
                                 {"row_b", result.matched.rows_b[i] + 1},
                                 {"rotation_deg", residual.rotation * degrees_per_radian},
                                 {"translation_mm", 1e3 * residual.translation},
                                 {"wrong", residual.wrong}});
  }
  return json;
}

std::string samples_text(const SolveResult& result) {
  const SampleCalibration& samples = *result.samples;
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < samples.residuals.size(); ++i)
    if (samples.residuals[i].wrong) wrong.push_back(rows_in_words(result.matched, i));
  std::string text = fmt::format(
      "samples       {}{}\nfit           spread of the target {:.3g} mm (median), {:.3g} mm (rms), {:.3g} mm "
      "at most; noise of one sample {:.3g} deg, {:.3g} mm\n",
      samples.residuals.size(),
      wrong.empty() ? std::string()
                    : fmt::format(", {} wrong and not used: {} {}", wrong.size(),
                                  wrong.size() == 1 ? "row" : "rows", fmt::join(wrong, ", ")),
      1e3 * samples.spread_median, 1e3 * samples.spread_rms, 1e3 * samples.spread_largest,
      samples.noise_rotation * degrees_per_radian, 1e3 * samples.noise_translation);
  const Pose& Y = samples.T_world_a_world_b;
  text += fmt::format("{:<14}x y z {:.6f} {:.6f} {:.6f} m, q w x y z {:.9f} {:.9f} {:.9f} {:.9f} ({})\n",
                      "target", Y.translation.x(), Y.translation.y(), Y.translation.z(), Y.rotation.w(),
                      Y.rotation.x(), Y.rotation.y(), Y.rotation.z(), target_name(result));
  return text;
}

}  // namespace egocal::tools
