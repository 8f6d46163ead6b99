// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <nlohmann/json.hpp>

#include "egocal/bus/pose_json.hpp"
#include "egocal/degrees.hpp"
#include "egocal/directions.hpp"
#include "egocal/evaluation/errors.hpp"
#include "offline/common/backing_of.hpp"
#include "offline/printing/report.hpp"
#include "offline/printing/samples.hpp"
#include "offline/printing/scale.hpp"
#include "offline/printing/trust.hpp"

namespace egocal::tools {

namespace {

nlohmann::ordered_json stream_json(const StreamSpan& stream) {
  return {{"poses", stream.poses}, {"first_s", stream.first}, {"last_s", stream.last}};
}

/// Four rows of four numbers.
nlohmann::ordered_json matrix_json(const Pose& T) {
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({R(i, 0), R(i, 1), R(i, 2), T.translation[i]});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

nlohmann::ordered_json nominal_json(const Calibration& calibration) {
  const std::array<Backing, 6> backing = backing_of(calibration);
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < 6; ++i)
    if (backing[i] == Backing::nominal) names.push_back(direction_names[i]);
  return names;
}

nlohmann::ordered_json time_offset_json(const TimeOffset& offset) {
  return {{"seconds", offset.seconds},         {"stddev", offset.stddev},
          {"correlation", offset.correlation}, {"rate", offset.rate},
          {"rate_stddev", offset.rate_stddev}, {"drifts", offset.drifts}};
}

/// Every reason, also those that did not occur.
nlohmann::ordered_json rejected_json(const PairingCounts& counts) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < counts.rejected.size(); ++i)
    json[std::string(to_string(static_cast<Rejection>(i)))] = counts.rejected[i];
  return json;
}

}  // namespace

nlohmann::ordered_json report_json(const SolveResult& result, const std::optional<Pose>& truth) {
  const Calibration& calibration = result.calibration;
  const Pose T = calibration.T_a_b;
  const Certificate& certificate = calibration.certificate;
  nlohmann::ordered_json json = trust_json(calibration);
  bus::put_pose(json, T);
  json["T_b_a"] = bus::pose_json(with_positive_scalar(calibration.T_b_a));
  json["matrix"] = matrix_json(T);
  json["pairs"] = sum_blocks(calibration.problem.blocks).count;
  json["cost"] = certificate.cost;
  json["lower_bound"] = certificate.lower_bound;
  json["gap"] = certificate.gap;
  json["certified"] = certificate.optimality == Optimality::certified;
  json["status"] = to_string(certificate.optimality);
  json["reach_translation"] = certificate.reach_translation;
  json["reach_rotation"] = certificate.reach_rotation;
  json["observable"] = calibration.observability.observable;
  json["stddev"] = calibration.observability.stddev;
  if (calibration.problem.prior) json["from_nominal"] = nominal_json(calibration);
  json["hint"] = calibration.observability.hint;
  json["method"] = result.method;
  json["note"] = result.note;
  json["solve_us"] = result.solve_us;
  json["mode"] = calibration.problem.mode == Mode::planar ? "planar" : "spatial";
  json["stride"] = calibration.choice.stride;
  json["weights"] = {{"rotation", calibration.choice.balance.rotation},
                     {"translation", calibration.choice.balance.translation}};
  json["mean_stride"] = calibration.choice.mean_stride > 0 ? calibration.choice.mean_stride
                                                           : static_cast<double>(calibration.choice.stride);
  json["choice"] = calibration.choice.reason;
  json["time_offset_s"] = calibration.time_offset_applied;
  if (!result.clocks.empty()) {
    json["time_offset_s"] = nullptr;
    json["time_offsets"] = nlohmann::ordered_json::array();
    for (const ClockOfDrive& clock : result.clocks) {
      nlohmann::ordered_json one = {{"drive", clock.name}};
      one.update(time_offset_json(clock.estimate));
      json["time_offsets"].push_back(std::move(one));
    }
  }
  if (calibration.time_offset) json["time_offset_estimate"] = time_offset_json(*calibration.time_offset);
  if (result.samples) json["samples"] = samples_json(result);
  if (calibration.scale) json["scale"] = scale_json(result);
  if (calibration.scale_applied != 1) json["scale_applied"] = calibration.scale_applied;
  json["synchronised"] = calibration.counts.synchronised;
  if (calibration.outliers)
    json["outlier_choice"] = {{"status", to_string(calibration.outliers->choice)},
                              {"undecided", calibration.outliers->undecided},
                              {"solves", calibration.outliers->solves}};
  json["outliers"] = calibration.counts.outliers;
  json["jumps"] = calibration.counts.jumps;
  json["rejected"] = rejected_json(calibration.counts);
  if (result.a) json["a"] = stream_json(*result.a);
  if (result.b) json["b"] = stream_json(*result.b);
  if (truth) {
    const ExtrinsicError error = extrinsic_error(to_dual_quaternion(*truth), to_dual_quaternion(T));
    json["error_translation_m"] = error.translation;
    json["error_rotation_deg"] = error.rotation * degrees_per_radian;
  }
  return json;
}

}  // namespace egocal::tools
