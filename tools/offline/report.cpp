// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "degrees.hpp"
#include "egocal/directions.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/in_words.hpp"
#include "egocal/microseconds.hpp"
#include "offline/named_extrinsic.hpp"
#include "offline/samples.hpp"
#include "offline/trust_report.hpp"

namespace egocal::tools {

namespace {

nlohmann::ordered_json stream_json(const StreamSpan& stream) {
  return {{"poses", stream.poses}, {"first_s", stream.first}, {"last_s", stream.last}};
}

const char* optimality_text(Optimality optimality) {
  switch (optimality) {
    case Optimality::certified:
      return "optimal (proven): no extrinsic has a lower cost";
    case Optimality::not_optimal:
      return "NOT OPTIMAL: a better extrinsic is known";
    case Optimality::undecided:
      break;
  }
  return "UNDECIDED: too imprecise to prove or disprove";
}

std::string pose_text(const char* label, const Pose& T) {
  const Eigen::Vector3d& t = T.translation;
  const Eigen::Vector3d angles = roll_pitch_yaw(T.rotation) * degrees;
  return fmt::format(
      "{}\n  translation x y z [m]          {:12.6f} {:12.6f} {:12.6f}\n"
      "  quaternion w x y z             {:12.9f} {:12.9f} {:12.9f} {:12.9f}\n"
      "  roll pitch yaw [deg]           {:12.5f} {:12.5f} {:12.5f}   R = Rz(yaw) Ry(pitch) Rx(roll)\n",
      label, t.x(), t.y(), t.z(), T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z(), angles.x(),
      angles.y(), angles.z());
}

Pose with_positive_scalar(Pose T) {
  if (T.rotation.w() < 0) T.rotation.coeffs() *= -1;
  return T;
}

/// Four rows of four numbers.
nlohmann::ordered_json matrix_json(const Pose& T) {
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({R(i, 0), R(i, 1), R(i, 2), T.translation[i]});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

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
  return "scale         changes along the drive; the extrinsic is one for all of it\n" + text;
}

nlohmann::ordered_json scale_json(const SolveResult& result) {
  const ScaleSolution& scale = *result.calibration.scale;
  return {{"value", scale.scale},
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

std::string scale_text(const Calibration& calibration) {
  if (!calibration.scale)
    return calibration.scale_applied == 1 ? ""
                                          : fmt::format("scale         {:g}\n", calibration.scale_applied);
  const ScaleSolution& scale = *calibration.scale;
  if (scale.at_limit)
    return fmt::format("scale         {:.6g} NOT FOUND: the end of the range that was searched\n",
                       scale.scale);
  const std::string value =
      scale.observable
          ? fmt::format("+- {:.6g}", scale.stddev)
          : "NOT OBSERVABLE, the motions do not show it: drive curves of different radius and speed";
  return fmt::format("scale         {:.6g} {}, {}, noise can hide up to {:.2g} % more or less\n", scale.scale,
                     value, scale.certified ? "certified over all scales" : "NOT CERTIFIED",
                     100 * scale.attenuation);
}

nlohmann::ordered_json nominal_json(const Calibration& calibration) {
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < 6; ++i)
    if (from_nominal(calibration, i)) names.push_back(direction_names[i]);
  return names;
}

}  // namespace

bool from_nominal(const Calibration& calibration, std::size_t direction) {
  return backing_of(calibration)[direction] == Backing::nominal;
}

bool any_from_nominal(const Calibration& calibration) {
  for (std::size_t i = 0; i < 6; ++i)
    if (from_nominal(calibration, i)) return true;
  return false;
}

nlohmann::ordered_json report_json(const SolveResult& result, const std::optional<Pose>& truth) {
  const Pose T = result.calibration.T_a_b;
  const Certificate& certificate = result.calibration.certificate;
  nlohmann::ordered_json json = trust_json(result.calibration);
  json["translation"] = {T.translation.x(), T.translation.y(), T.translation.z()};
  json["rotation_wxyz"] = {T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z()};
  const Pose T_b_a = with_positive_scalar(result.calibration.T_b_a);
  json["T_b_a"] = {
      {"translation", {T_b_a.translation.x(), T_b_a.translation.y(), T_b_a.translation.z()}},
      {"rotation_wxyz", {T_b_a.rotation.w(), T_b_a.rotation.x(), T_b_a.rotation.y(), T_b_a.rotation.z()}}};
  json["matrix"] = matrix_json(T);
  json["pairs"] = sum_blocks(result.calibration.problem.blocks).count;
  json["cost"] = certificate.cost;
  json["lower_bound"] = certificate.lower_bound;
  json["gap"] = certificate.gap;
  json["certified"] = certificate.optimality == Optimality::certified;
  json["status"] = to_string(certificate.optimality);
  json["reach_translation"] = certificate.reach_translation;
  json["reach_rotation"] = certificate.reach_rotation;
  json["observable"] = result.calibration.observability.observable;
  json["stddev"] = result.calibration.observability.stddev;
  if (result.calibration.problem.prior) json["from_nominal"] = nominal_json(result.calibration);
  json["hint"] = result.calibration.observability.hint;
  json["method"] = result.method;
  json["note"] = result.note;
  json["solve_us"] = result.solve_us;
  json["mode"] = result.calibration.problem.mode == Mode::planar ? "planar" : "spatial";
  json["stride"] = result.calibration.choice.stride;
  json["weights"] = {{"rotation", result.calibration.choice.balance.rotation},
                     {"translation", result.calibration.choice.balance.translation}};
  json["mean_stride"] = result.calibration.choice.mean_stride > 0
                            ? result.calibration.choice.mean_stride
                            : static_cast<double>(result.calibration.choice.stride);
  json["choice"] = result.calibration.choice.reason;
  json["time_offset_s"] = result.calibration.time_offset_applied;
  if (result.calibration.time_offset)
    json["time_offset_estimate"] = {{"seconds", result.calibration.time_offset->seconds},
                                    {"stddev", result.calibration.time_offset->stddev},
                                    {"correlation", result.calibration.time_offset->correlation},
                                    {"rate", result.calibration.time_offset->rate},
                                    {"rate_stddev", result.calibration.time_offset->rate_stddev},
                                    {"drifts", result.calibration.time_offset->drifts}};
  if (result.samples) json["samples"] = samples_json(result);
  if (result.calibration.scale) json["scale"] = scale_json(result);
  if (result.calibration.scale_applied != 1) json["scale_applied"] = result.calibration.scale_applied;
  json["synchronised"] = result.calibration.counts.synchronised;
  if (result.calibration.outliers)
    json["outlier_choice"] = {{"status", to_string(result.calibration.outliers->choice)},
                              {"undecided", result.calibration.outliers->undecided},
                              {"solves", result.calibration.outliers->solves}};
  json["outliers"] = result.calibration.counts.outliers;
  json["jumps"] = result.calibration.counts.jumps;
  json["rejected"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < result.calibration.counts.rejected.size(); ++i)
    json["rejected"][std::string(to_string(static_cast<Rejection>(i)))] =
        result.calibration.counts.rejected[i];
  if (result.a) json["a"] = stream_json(*result.a);
  if (result.b) json["b"] = stream_json(*result.b);
  if (truth) {
    const ExtrinsicError error =
        extrinsic_error(to_dual_quaternion(*truth), to_dual_quaternion(result.calibration.T_a_b));
    json["error_translation_m"] = error.translation;
    json["error_rotation_deg"] = error.rotation * degrees;
  }
  return json;
}

std::string report_text(const SolveResult& result, const std::optional<Pose>& truth) {
  const Calibration& calibration = result.calibration;
  const Pose T = calibration.T_a_b;
  std::string text = trust_text(calibration);
  if (result.samples) text += samples_text(result);
  text += fmt::format("optimality    {} (method {}, {:.2f} us)\n\n",
                      optimality_text(calibration.certificate.optimality), result.method, result.solve_us);
  text += pose_text("T_a_b, pose of sensor b in sensor a (p_a = T_a_b p_b)", T);
  text += pose_text("T_b_a, its inverse", with_positive_scalar(calibration.T_b_a));

  text += "\nmotions       " + motions_in_words(calibration) + "\n";
  if (calibration.counts.jumps > 0)
    text += fmt::format("jumps         {} in the odometry, no motion spans them\n", calibration.counts.jumps);
  if (const std::uint64_t count = calibration.counts.outliers; count > 0)
    text += fmt::format("outliers      {} {} these\n", counted(count, "more pair"),
                        count == 1 ? "contradicts" : "contradict");
  if (calibration.outliers && calibration.outliers->choice == OutlierChoice::proven)
    text += "outliers      proven: no other choice of them has an extrinsic that fits better\n";
  else if (calibration.outliers)
    text += fmt::format("outliers      not proven: {} of the drive could change sides\n",
                        counted(calibration.outliers->undecided, "part"));
  for (const auto& [label, stream] : {std::pair{"a", result.a}, std::pair{"b", result.b}})
    if (stream)
      text += fmt::format("stream {}      {}\n", label,
                          span_in_words(stream->poses, stream->first, stream->last));
  std::vector<std::string> pairing;
  if (result.a)
    pairing.push_back(fmt::format("{} instants synchronised", result.calibration.counts.synchronised));
  for (std::size_t i = 0; i < result.calibration.counts.rejected.size(); ++i)
    if (result.calibration.counts.rejected[i] > 0)
      pairing.push_back(fmt::format("{} rejected: {}", result.calibration.counts.rejected[i],
                                    to_string(static_cast<Rejection>(i))));
  if (!pairing.empty()) text += fmt::format("pairing       {}\n", fmt::join(pairing, ", "));
  text += scale_text(result.calibration);
  text += segments_text(result);
  if (result.calibration.time_offset)
    text += fmt::format("time offset   {:.4f} +- {:.4f} s added to b (correlation {:.2f})\n",
                        result.calibration.time_offset->seconds, result.calibration.time_offset->stddev,
                        result.calibration.time_offset->correlation);
  if (result.calibration.time_offset && result.calibration.time_offset->drifts)
    text += fmt::format("clock drift   {:.1f} +- {:.1f} us/s of b, corrected\n",
                        1e6 * result.calibration.time_offset->rate,
                        1e6 * result.calibration.time_offset->rate_stddev);
  if (!result.calibration.time_offset && result.calibration.time_offset_applied != 0)
    text += fmt::format("time offset   {:.4f} s added to b\n", result.calibration.time_offset_applied);

  const Certificate& certificate = calibration.certificate;
  text += fmt::format(
      "\ncertificate   cost {:.6g}, lower bound {:.6g}, gap {:.3g} ({:.2f} of rounding); anything as good is "
      "within {:.2g} "
      "m, {:.2g} deg\n",
      certificate.cost, certificate.lower_bound, certificate.gap, certificate.scaled_gap,
      certificate.reach_translation, certificate.reach_rotation * degrees);
  if (any_from_nominal(calibration)) text += fmt::format("              {}\n", cost_with_nominal);
  if (!result.note.empty()) text += fmt::format("              {}\n", result.note);
  text += "uncertainty   in the frame of a, one standard deviation\n";
  const std::array<Backing, 6> backing = backing_of(calibration);
  for (std::size_t i = 0; i < 6; ++i) {
    const double stddev = calibration.observability.stddev[i];
    const bool rotation = i >= 3;
    std::string value = "NOT OBSERVABLE, the number above is not a measurement";
    if (backing[i] == Backing::planes) value = "from the ground planes";
    if (backing[i] == Backing::nominal) value = "NOT OBSERVABLE, from the nominal value";
    if (calibration.observability.observable[i])
      value = std::isfinite(stddev)
                  ? fmt::format("+- {:.3f} {}", stddev * (rotation ? degrees : 100), rotation ? "deg" : "cm")
                  : "observable, too few motions for a standard deviation";
    text += fmt::format("  {:<12}{}\n", direction_names[i], value);
  }
  if (!calibration.observability.hint.empty()) text += fmt::format("  {}\n", calibration.observability.hint);
  if (truth) {
    const ExtrinsicError error =
        extrinsic_error(to_dual_quaternion(*truth), to_dual_quaternion(result.calibration.T_a_b));
    text += fmt::format("\nerror against the truth (32)   {:.3f} deg, {:.2f} cm\n", error.rotation * degrees,
                        error.translation * 100);
  }
  return text;
}

}  // namespace egocal::tools
