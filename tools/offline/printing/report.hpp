// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "offline/pair/calibration.hpp"

namespace egocal::tools {

/// Whether the nominal value gives what the motions do not show of some direction.
bool any_from_nominal(const Calibration& calibration);
/// What the cost then is, one sentence.
inline constexpr const char* cost_with_nominal =
    "The nominal value holds what the motions do not show, and is a part of this cost.";
/// The same pose with w >= 0 in its quaternion.
Pose with_positive_scalar(Pose T);

/// One JSON object (docs/json.md); numbers that are not finite are null when it is printed.
nlohmann::ordered_json report_json(const SolveResult& result, const std::optional<Pose>& truth);
/// What T_a_b is the pose of, and in which frame the standard deviations are. With --eye-to-hand the poses of
/// the hand are inverted, so it is that of the camera in the base.
struct AnswerFrames {
  const char* title;
  const char* frame;
};
AnswerFrames frames_of_answer(bool eye_to_hand);
/// The offset and the drift of b's clock, a line each; empty: there are none.
std::string clocks_text(const Calibration& calibration);
/// The same of drives that have clocks of their own, a line for each drive.
std::string clocks_text(const std::vector<ClockOfDrive>& clocks);
/// The result for people: degrees and centimetres, both directions of T, fit and optimality and uncertainty
/// kept apart.
std::string report_text(const SolveResult& result, const std::optional<Pose>& truth);

}  // namespace egocal::tools
