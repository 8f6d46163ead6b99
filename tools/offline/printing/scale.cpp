// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/printing/scale.hpp"

#include <fmt/format.h>

#include "egocal/microseconds.hpp"
#include "offline/pair/unit.hpp"

namespace egocal::tools {

namespace {

nlohmann::ordered_json segments_json(const SolveResult& result) {
  nlohmann::ordered_json segments = nlohmann::ordered_json::array();
  if (!result.course || !result.a) return segments;
  const auto seconds = [&](std::int64_t time_us) { return to_seconds(time_us) - result.a->first; };
  for (const ScaleSegment& segment : result.course->segments)
    segments.push_back({{"begin_s", seconds(segment.begin_us)},
                        {"end_s", seconds(segment.end_us)},
                        {"begin_scale", segment.begin_scale},
                        {"end_scale", segment.end_scale},
                        {"stddev", segment.stddev}});
  return segments;
}

std::string segments_text(const SolveResult& result) {
  if (!result.course || !result.a) return "";
  return "scale         changes along the drive; the extrinsic is one for all of it\n" +
         scale_course_text(result);
}

std::string value_text(const SolveResult& result) {
  const Calibration& calibration = result.calibration;
  const std::string of = std::string(" times the lengths of ") + scaled_name(result);
  if (!calibration.scale)
    return calibration.scale_applied == 1
               ? ""
               : fmt::format("scale         {:g}{}\n", calibration.scale_applied, of);
  const ScaleSolution& scale = *calibration.scale;
  if (scale.at_limit)
    return fmt::format("scale         {:.6g} NOT FOUND: the end of the range that was searched\n",
                       scale.scale);
  const std::string value =
      scale.observable
          ? fmt::format("+- {:.6g}", scale.stddev)
          : "NOT OBSERVABLE, the motions do not show it: drive curves of different radius and speed";
  return fmt::format(
      "scale         {:.6g} {}{}{} are those of {}; {}, noise can hide up to {:.2g} % more or less\n",
      scale.scale, value, scale.observable ? "" : ";", of, unscaled_name(result),
      scale.certified ? "certified over all scales" : "NOT CERTIFIED", 100 * scale.attenuation);
}

}  // namespace

std::string scale_course_text(const SolveResult& result) {
  std::string text;
  if (!result.course || !result.a) return text;
  for (const ScaleSegment& segment : result.course->segments) {
    const double begin = to_seconds(segment.begin_us) - result.a->first;
    const double end = to_seconds(segment.end_us) - result.a->first;
    text += segment.begin_scale == segment.end_scale
                ? fmt::format("  from {:.1f} to {:.1f} s   {:.6g} +- {:.2g}\n", begin, end,
                              segment.begin_scale, segment.stddev)
                : fmt::format("  from {:.1f} to {:.1f} s   drifts from {:.6g} to {:.6g} (+- {:.2g})\n", begin,
                              end, segment.begin_scale, segment.end_scale, segment.stddev);
  }
  return text;
}

nlohmann::ordered_json scale_json(const SolveResult& result) {
  const ScaleSolution& scale = *result.calibration.scale;
  return {{"of", scaled_name(result)},
          {"unit_of", unscaled_name(result)},
          {"metres", in_metres(result)},
          {"value", scale.scale},
          {"stddev", scale.stddev},
          {"observable", scale.observable},
          {"certified", scale.certified},
          {"at_limit", scale.at_limit},
          {"least", scale.least_scale},
          {"most", scale.most_scale},
          {"gap", scale.gap},
          {"attenuation", scale.attenuation},
          {"observability", scale.observability},
          {"solves", scale.solves},
          {"segments", segments_json(result)}};
}

std::string scale_text(const SolveResult& result) {
  return value_text(result) + segments_text(result);
}

}  // namespace egocal::tools
