// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/pair/unit.hpp"

#include <fmt/format.h>

namespace egocal::tools {

namespace {

bool scaled_has_scale(const SolveResult& result) {
  return result.scale_side == Side::a ? result.a_has_scale : result.b_has_scale;
}

bool unscaled_has_scale(const SolveResult& result) {
  return result.scale_side == Side::a ? result.b_has_scale : result.a_has_scale;
}

/// The option for the other side.
std::string other_side(const SolveResult& result) {
  return result.scale_side == Side::a ? "--scale-b auto" : "--scale-a auto";
}

}  // namespace

const char* scaled_name(const SolveResult& result) {
  return result.scale_side == Side::a ? "a" : "b";
}

const char* unscaled_name(const SolveResult& result) {
  return result.scale_side == Side::a ? "b" : "a";
}

bool in_metres(const SolveResult& result) {
  if (!scaled_has_scale(result) && !unscaled_has_scale(result)) return false;
  if (!result.calibration.scale) return true;
  if (!unscaled_has_scale(result)) return false;
  return !scaled_has_scale(result) || unit_of_scaled(LengthUnit::metres_where_alike,
                                                     result.calibration.scale->scale) == LengthUnit::metres;
}

LengthUnit unit_of_answer(const SolveRequest& request, const SolveResult& result) {
  const bool scaled = request.calibration.estimate_scale || request.calibration.scale != 1;
  if (scaled ? !unscaled_has_scale(result) : !scaled_has_scale(result) && !unscaled_has_scale(result))
    return LengthUnit::unknown;
  const bool unnamed =
      request.calibration.estimate_scale && request.scale_option == "--scale" && scaled_has_scale(result);
  return unnamed ? LengthUnit::metres_where_alike : LengthUnit::metres;
}

std::string unit_of_lengths(const SolveResult& result) {
  return in_metres(result) ? "m" : std::string("unit of ") + unscaled_name(result);
}

std::string unit_text(const SolveResult& result) {
  if (in_metres(result)) return "";
  const std::string begin = fmt::format(
      "unit          lengths are in the unit of {0}, also where m or cm is written: ", unscaled_name(result));
  if (!unscaled_has_scale(result)) return begin + "not metres, its format has no scale\n";
  return begin + fmt::format("metres only if {} measures metres. If {} does: {}\n", unscaled_name(result),
                             scaled_name(result), other_side(result));
}

std::string scale_warning(const SolveRequest& request, const SolveResult& result) {
  if (in_metres(result)) return "";
  const std::string unit = fmt::format("the translation is in the unit of {}", unscaled_name(result));
  if (!unscaled_has_scale(result))
    return unit + ", whose format has no scale: these are not metres" +
           (scaled_has_scale(result)
                ? fmt::format("; if {} measures metres: {}", scaled_name(result), other_side(result))
                : std::string());
  if (request.scale_option != "--scale") return "";
  return fmt::format(
      "{}, and the scale that was found, {:.4g}, is far from 1: metres only if {} measures metres; if {} "
      "does and {} is the camera without scale: {}, otherwise --scale-a auto",
      unit, result.calibration.scale->scale, unscaled_name(result), scaled_name(result),
      unscaled_name(result), other_side(result));
}

}  // namespace egocal::tools
