// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "answer_text.hpp"

#include <algorithm>
#include <cmath>

namespace egocal::monitor {

double seconds(std::int64_t from_us, std::int64_t to_us) {
  return (static_cast<double>(to_us) - static_cast<double>(from_us)) * 1e-6;
}

double scale_of(int direction) {
  return direction < 3 ? kCentimetres : kDegrees;
}

bool from_ground(const PairState& pair, int direction) {
  return pair.has_problem && pair.problem.mode == 1 && direction >= 2 && direction <= 4;
}

bool shown_by_motion(const calibration_t& answer, int direction) {
  return answer.observable[direction] != 0;
}

std::array<double, 6> components(const Pose& T) {
  const Eigen::Vector3d rpy = roll_pitch_yaw(T.rotation);
  return {T.translation.x(), T.translation.y(), T.translation.z(), rpy.x(), rpy.y(), rpy.z()};
}

std::string spread(const PairState& pair, const calibration_t& answer, int direction, int decimals,
                   Charset charset) {
  if (from_ground(pair, direction)) return "plane";
  const double value = answer.stddev[direction] * scale_of(direction);
  return symbols(charset).plus_minus + number(value, value < 10 ? decimals : decimals - 1, charset);
}

std::string centimetres(double metres, Charset charset) {
  const double value = metres * kCentimetres;
  return number(value, std::abs(value) < 100 ? 2 : 1, charset) + " cm";
}
std::string degrees(double radians, Charset charset) {
  const double value = radians * kDegrees;
  return number(value, std::abs(value) < 10 ? 3 : 1, charset) + (charset == Charset::unicode ? "°" : " deg");
}

double largest(const double* values) {
  return std::max({values[0], values[1], values[2]});
}

std::string missing_directions(const PairState& pair, const calibration_t& answer) {
  std::string text;
  for (int i = 0; i < 6; ++i)
    if (!shown_by_motion(answer, i) && !from_ground(pair, i))
      text += (text.empty() ? "" : " ") + std::string(kDirections[i]);
  return text;
}

std::string latency(const calibration_t& answer, Charset charset) {
  return answer.latency_us < 0 ? "-" : duration(static_cast<double>(answer.latency_us) * 1e-6, charset);
}
std::string solve_time(const calibration_t& answer, Charset charset) {
  return duration(static_cast<double>(answer.solve_ns) * 1e-9, charset);
}
std::string verify_time(const calibration_t& answer, Charset charset) {
  return duration(static_cast<double>(answer.verify_ns) * 1e-9, charset);
}

Verdict verdict_of(const PairState& pair, Charset charset) {
  const Symbols& s = symbols(charset);
  const calibration_t* answer = pair.answer();
  if (!answer) return {pair.has_problem ? "solving" : "waiting", Style::dim};
  if (!pair.shown.valid) return {std::string(s.no) + " unusable", Style::bad};
  if (answer->status == 0) return {std::string(s.yes) + " certified", Style::good};
  if (answer->status == 1) return {std::string(s.no) + " not best", Style::bad};
  return {"? undecided", Style::warning};
}

std::string pair_title(const PairState& pair, Charset charset, std::size_t max) {
  return clean(pair.a, max) + " " + symbols(charset).arrow + " " + clean(pair.b, max);
}

std::string short_solver(const std::string& name, std::size_t max) {
  const std::string prefix = "egocal-";
  return clean(name.rfind(prefix, 0) == 0 && name.size() > prefix.size() ? name.substr(prefix.size()) : name,
               max);
}

Style solver_style(Role role) {
  return role == Role::global ? Style::global : Style::fast;
}

}  // namespace egocal::monitor
