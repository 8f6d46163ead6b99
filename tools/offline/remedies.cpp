// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/remedies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace egocal::tools {

namespace {

void replace(std::string& text, const std::string& part, const std::string& by) {
  if (const std::size_t at = text.find(part); at != std::string::npos) text.replace(at, part.size(), by);
}

/// own, other: whether the poses of this stream and of the other one are inverted by an option.
void word_inverted(Finding& finding, char which, bool own, bool other) {
  const char rest = which == 'a' ? 'b' : 'a';
  if (own) {
    replace(finding.message, "are world-to-sensor, not sensor-to-world",
            fmt::format("are sensor-to-world already, --invert-{} makes them world-to-sensor", which));
    replace(finding.remedy, fmt::format("--invert-{}", which), fmt::format("leave out --invert-{}", which));
  } else if (other) {
    // both inverted, or none: without noise the motions do not tell which
    replace(
        finding.message, fmt::format("The poses of {} are world-to-sensor, not sensor-to-world", which),
        fmt::format("The poses of {} are inverted by --invert-{}, those of {} are not", rest, rest, which));
    replace(finding.remedy, fmt::format("--invert-{}", which),
            fmt::format("leave out --invert-{}, or give --invert-{} as well", rest, which));
  }
}

void word_inverted_both(Finding& finding, bool a, bool b) {
  if (!a && !b) return;
  const std::string cure = a && b ? "leave out --invert-a and --invert-b"
                           : a    ? "leave out --invert-a and give --invert-b"
                                  : "leave out --invert-b and give --invert-a";
  if (a && b) {
    replace(finding.message, "are world-to-sensor, not sensor-to-world", "are sensor-to-world already");
    replace(finding.message, "If the poses of both streams are world-to-sensor",
            "If the poses of both streams are sensor-to-world already");
    replace(finding.remedy, "Make sure that the poses are sensor-to-world",
            "Make sure that the poses are world-to-sensor");
  }
  replace(finding.remedy, "--invert-a --invert-b", cure);
}

/// The factor was given: another one takes its place.
void word_scale(Finding& finding, const CalibrationOptions& options) {
  if (!finding.value || !(*finding.value > 0)) return;
  const bool of_a = options.scale_side == Side::a;
  const std::string option = of_a ? "--scale" : "--scale-b";
  const double right = of_a ? options.scale / *finding.value : options.scale * *finding.value;
  constexpr double none = 1e-3;  // limit: a factor that is one
  if (std::abs(right - 1) < none)
    finding.remedy = fmt::format("leave out {}", option);
  else
    finding.remedy = fmt::format("{} {:.4g} or {} auto, in place of {} {:.10g}", option, right, option,
                                 option, options.scale);
}

}  // namespace

void word_for_options(const CalibrationOptions& options, Calibration& calibration) {
  const bool invert_a = options.read_a.invert, invert_b = options.read_b.invert;
  const bool scale_given = options.scale != 1 && !options.estimate_scale;
  for (Finding& finding : calibration.findings) {
    const std::string message = finding.message;
    if (finding.code == "inverted_a") word_inverted(finding, 'a', invert_a, invert_b);
    if (finding.code == "inverted_b") word_inverted(finding, 'b', invert_b, invert_a);
    if (finding.code == "inverted_both") word_inverted_both(finding, invert_a, invert_b);
    if (scale_given && (finding.code == "scale" || finding.code == "units")) word_scale(finding, options);
    if (calibration.reason == message) calibration.reason = finding.message;
  }
}

void word_for_eye_to_hand(Calibration& calibration) {
  for (Finding& finding : calibration.findings) {
    if (finding.code != "inverted_a") continue;
    const std::string message = finding.message;
    replace(finding.message, "With the poses of a inverted", "Without --eye-to-hand");
    replace(finding.message, "they are base-to-hand, or the camera stands beside the arm and sees the hand",
            "the camera is on the hand, or the poses of a are base-to-hand");
    finding.remedy = "Leave out --eye-to-hand.";
    if (calibration.reason == message) calibration.reason = finding.message;
  }
}

std::string advice_of_solve(std::string advice) {
  std::size_t first = std::string::npos;
  for (const char* option : {"--time-offset", "--max-gap", "--scale", "--invert-", "--quaternion-order-",
                             "--samples", "--eye-", "--plane-"})
    first = std::min(first, advice.find(option));
  if (first != std::string::npos) advice.insert(first, "egocal solve A B ");
  return advice;
}

}  // namespace egocal::tools
