// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "egocal/degrees.hpp"
#include "egocal/directions.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/in_words.hpp"
#include "offline/common/backing_of.hpp"
#include "offline/pair/unit.hpp"
#include "offline/printing/decimals.hpp"
#include "offline/printing/report.hpp"
#include "offline/printing/samples.hpp"
#include "offline/printing/scale.hpp"
#include "offline/printing/trust.hpp"

namespace egocal::tools {

namespace {

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

std::string pose_text(const char* label, const Pose& T, const std::string& unit) {
  const Eigen::Vector3d t = without_negative_zeros(T.translation, 6);
  const Eigen::Vector3d angles = without_negative_zeros(roll_pitch_yaw(T.rotation) * degrees_per_radian, 5);
  return fmt::format(
      "{}\n  {:<30} {:12.6f} {:12.6f} {:12.6f}\n"
      "  quaternion w x y z             {:12.9f} {:12.9f} {:12.9f} {:12.9f}\n"
      "  roll pitch yaw [deg]           {:12.5f} {:12.5f} {:12.5f}   R = Rz(yaw) Ry(pitch) Rx(roll)\n",
      label, "translation x y z [" + unit + "]", t.x(), t.y(), t.z(), T.rotation.w(), T.rotation.x(),
      T.rotation.y(), T.rotation.z(), angles.x(), angles.y(), angles.z());
}

/// What was rejected of the motions, and whether that choice is proven.
std::string outliers_text(const Calibration& calibration) {
  std::string text;
  if (calibration.counts.jumps > 0)
    text += fmt::format("jumps         {} in the odometry, no motion spans them\n", calibration.counts.jumps);
  if (const std::uint64_t count = calibration.counts.outliers; count > 0)
    text += fmt::format("outliers      {} {} these\n", counted(count, "more pair"),
                        count == 1 ? "contradicts" : "contradict");
  if (calibration.outliers && calibration.outliers->choice == OutlierChoice::proven)
    // that it is the best choice makes no bad fit good, and "proven" reads like it
    text +=
        calibration.verdict < Verdict::doubtful
            ? "outliers      proven: no other choice of them has an extrinsic that fits better\n"
            : fmt::format(
                  "outliers      no other choice of them fits better, and with this one the answer is {}\n",
                  to_string(calibration.verdict));
  else if (calibration.outliers)
    text += fmt::format("outliers      not proven: {} of the drive could change sides\n",
                        counted(calibration.outliers->undecided, "part"));
  return text;
}

/// What was read, and what pairing made of it.
std::string pairing_text(const SolveResult& result) {
  std::string text;
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
  return text;
}

std::string certificate_text(const SolveResult& result) {
  const Certificate& certificate = result.calibration.certificate;
  std::string text = fmt::format(
      "\ncertificate   cost {:.6g}, lower bound {:.6g}, gap {:.3g} ({:.2f} of rounding); anything as good is "
      "within {:.2g} m, {:.2g} deg\n",
      certificate.cost, certificate.lower_bound, certificate.gap, certificate.scaled_gap,
      certificate.reach_translation, certificate.reach_rotation * degrees_per_radian);
  if (any_from_nominal(result.calibration)) text += fmt::format("              {}\n", cost_with_nominal);
  if (!result.note.empty()) text += fmt::format("              {}\n", result.note);
  return text;
}

std::string uncertainty_text(const Calibration& calibration, const char* frame) {
  std::string text = fmt::format("uncertainty   in the frame of {}, one standard deviation\n", frame);
  const std::array<Backing, 6> backing = backing_of(calibration);
  for (std::size_t i = 0; i < 6; ++i) {
    const double stddev = calibration.observability.stddev[i];
    const bool rotation = i >= 3;
    std::string value = "NOT OBSERVABLE, the number above is not a measurement";
    if (backing[i] == Backing::planes) value = "from the ground planes";
    if (backing[i] == Backing::nominal) value = "NOT OBSERVABLE, from the nominal value";
    if (calibration.observability.observable[i])
      value = std::isfinite(stddev)
                  ? fmt::format("+- {:.3f} {}", stddev * (rotation ? degrees_per_radian : 100),
                                rotation ? "deg" : "cm")
                  : "observable, too few motions for a standard deviation";
    text += fmt::format("  {:<12}{}\n", direction_names[i], value);
  }
  // more motion does not help where the motions contradict each other
  if (!calibration.observability.hint.empty() && calibration.verdict != Verdict::contradictory)
    text += fmt::format("  {}\n", calibration.observability.hint);
  return text;
}

}  // namespace

AnswerFrames frames_of_answer(bool eye_to_hand) {
  if (eye_to_hand) return {"T_a_b, pose of the camera in the base (p_base = T_a_b p_camera)", "the base"};
  return {"T_a_b, pose of sensor b in sensor a (p_a = T_a_b p_b)", "a"};
}

std::string clocks_text(const std::vector<ClockOfDrive>& clocks) {
  std::string text;
  for (std::size_t k = 0; k < clocks.size(); ++k) {
    const TimeOffset& offset = clocks[k].estimate;
    text +=
        fmt::format("time offset   {:.4f} +- {:.4f} s added to b in drive {} ({}; correlation {:.2f}{})\n",
                    offset.seconds, offset.stddev, k + 1, clocks[k].name, offset.correlation,
                    offset.drifts ? fmt::format("; drift {:.1f} us/s, corrected", 1e6 * offset.rate) : "");
  }
  return text;
}

std::string clocks_text(const Calibration& calibration) {
  std::string text;
  if (calibration.time_offset)
    text += fmt::format("time offset   {:.4f} +- {:.4f} s added to b (correlation {:.2f})\n",
                        calibration.time_offset->seconds, calibration.time_offset->stddev,
                        calibration.time_offset->correlation);
  if (calibration.time_offset && calibration.time_offset->drifts)
    text += fmt::format("clock drift   {:.1f} +- {:.1f} us/s of b, corrected\n",
                        1e6 * calibration.time_offset->rate, 1e6 * calibration.time_offset->rate_stddev);
  if (!calibration.time_offset && calibration.time_offset_applied != 0)
    text += fmt::format("time offset   {:.4f} s added to b\n", calibration.time_offset_applied);
  return text;
}

std::string report_text(const SolveResult& result, const std::optional<Pose>& truth) {
  const Calibration& calibration = result.calibration;
  std::string text = trust_text(calibration) + unit_text(result);
  if (result.samples) text += samples_text(result);
  text += fmt::format("optimality    {} (method {}, {:.2f} us)\n\n",
                      optimality_text(calibration.certificate.optimality), result.method, result.solve_us);
  const std::string unit = unit_of_lengths(result);
  text += pose_text(frames_of_answer(result.eye_to_hand).title, calibration.T_a_b, unit);
  if (const std::string not_shown = not_shown_in_words(calibration); !not_shown.empty())
    text += "  " + not_shown + "\n";
  text += pose_text("T_b_a, its inverse", with_positive_scalar(calibration.T_b_a), unit);
  text += "\nmotions       " + motions_in_words(calibration) + "\n";
  text += outliers_text(calibration);
  text += pairing_text(result);
  text += scale_text(result);
  text += result.clocks.empty() ? clocks_text(calibration) : clocks_text(result.clocks);
  text += certificate_text(result);
  text += uncertainty_text(calibration, frames_of_answer(result.eye_to_hand).frame);
  if (truth) {
    const ExtrinsicError error =
        extrinsic_error(to_dual_quaternion(*truth), to_dual_quaternion(calibration.T_a_b));
    text += fmt::format("\nerror against the truth (32)   {:.3f} deg, {:.2f} cm\n",
                        error.rotation * degrees_per_radian, error.translation * 100);
  }
  return text;
}

}  // namespace egocal::tools
