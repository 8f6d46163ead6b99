// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/words/wording.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <utility>

#include "diagnosis/motions/axes.hpp"
#include "egocal/degrees.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

std::string fits(const Finding& finding) {
  std::string smaller = format("the squared residuals are %.3g times smaller then", finding.improvement);
  if (finding.certain) return smaller;
  constexpr double alike = 2;  // wording alone: residuals within this factor fit both readings
  return finding.improvement > alike ? smaller + ", and another reading fits as well"
                                     : "the motions fit both readings";
}

/// "x from -y, y from x, z from z": the columns of the position that were meant.
std::string columns(const Eigen::Matrix3d& axes) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (axes(row, column) == 0) continue;
      text += text.empty() ? "" : ", ";
      text += "xyz"[row];
      text += axes(row, column) < 0 ? " from -" : " from ";
      text += "xyz"[column];
    }
  }
  return text;
}

/// What must be done to the positions so that they suit the rotations.
std::string turned(const Eigen::Matrix3d& axes) {
  const bool mirrored = axes.determinant() < 0;
  const Eigen::Vector3d turn = turn_of(axes);
  const double angle = turn.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitZ();
  return format("positions turned by %.1f deg about %s%s", angle * degrees_per_radian,
                axis_in_words(axis).c_str(), mirrored ? " and mirrored at the origin" : "");
}

void word_axes(Finding& finding, const PoseReading& reading, const char* stream) {
  std::string change;
  if (reading.invert) {
    change = "positions taken as those of the inverse poses";
  } else {
    if (!is_permutation(reading.axes))
      change = turned(reading.axes);
    else if (!reading.axes.isIdentity())
      change = "position columns read as " + columns(reading.axes);
    if (reading.conjugate)
      change += std::string(change.empty() ? "" : ", and ") + "each rotation taken as its inverse";
  }
  say(finding, format("The position and the rotation of %s do not belong together", stream),
      format("Write positions and rotations of %s in the same axes.", stream),
      format(": with %s, %s.", change.c_str(), fits(finding).c_str()));
}

}  // namespace

std::string axis_in_words(const Eigen::Vector3d& axis) {
  const Eigen::Array3d shown = (100 * axis.array()).round() / 100 + 0.0;  // -0.0 + 0.0 is 0.0
  return format("(%.2f, %.2f, %.2f)", shown.x(), shown.y(), shown.z());
}

const char* mark(char stream) {
  return stream == 'a' ? "{a}" : "{b}";
}

std::string format(const char* pattern, ...) {
  char text[512];
  std::va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

Finding certain_finding(const char* code, std::string message, std::string remedy) {
  Finding finding;
  finding.code = code;
  finding.certain = true;
  finding.message = std::move(message);
  finding.remedy = std::move(remedy);
  return finding;
}

std::string length_in_words(double length, bool metres) {
  // "%.3g" of 999.5 and more would be "1e+03"
  if (!metres) return length < 999.5 ? format("%.3g units", length) : format("%.0f units", length);
  if (!(100 * length >= 999.5)) return format("%.3g cm", 100 * length);
  return length < 999.5 ? format("%.3g m", length) : format("%.0f m", length);
}

Finding worded_reading(Finding finding, const PoseReading& read_a, const PoseReading& read_b) {
  const std::string& code = finding.code;
  const char* order_a = read_a.quaternion_order == QuaternionOrder::xyzw ? "xyzw" : "wxyz";
  const char* order_b = read_b.quaternion_order == QuaternionOrder::xyzw ? "xyzw" : "wxyz";
  if (code == "inverted_a" || code == "inverted_b") {
    const char which = code.back();
    say(finding, format("The poses of %s are world-to-sensor, not sensor-to-world", mark(which)),
        format("{solve}--invert-%c", which), format(": %s.", fits(finding).c_str()));
  } else if (code == "inverted_both") {
    if (finding.certain)
      say(finding, "The poses of both streams are world-to-sensor, not sensor-to-world",
          "{solve}--invert-a --invert-b", ".");
    else
      say(finding, "If the poses of both streams are world-to-sensor",
          "Make sure that the poses are sensor-to-world; otherwise {solve}--invert-a --invert-b",
          ", the answer is another one; the motions cannot tell.");
  } else if (code == "quaternion_order_a" || code == "quaternion_order_b") {
    const char which = code.back();
    const char* order = which == 'a' ? order_a : order_b;
    const bool inverted = (which == 'a' ? read_a : read_b).invert;
    say(finding,
        format("The quaternions of %s are in the order %s%s", mark(which), order,
               inverted ? ", and its poses are world-to-sensor" : ""),
        format("{solve}--quaternion-order-%c %s", which, order) +
            (inverted ? format(" --invert-%c", which) : ""),
        format(": %s.", fits(finding).c_str()));
  } else if (code == "quaternion_order_both") {
    say(finding, format("The quaternions of both streams are in the order %s", order_a),
        format("{solve}--quaternion-order-a %s --quaternion-order-b %s", order_a, order_b),
        format(": %s.", fits(finding).c_str()));
  } else if (code == "axes_a") {
    word_axes(finding, read_a, mark('a'));
  } else if (code == "axes_b") {
    word_axes(finding, read_b, mark('b'));
  } else if (code == "axes_both") {
    word_axes(finding, read_a, "both streams");
  }
  return finding;
}

Finding worded_scale(Finding finding, bool either) {
  const double scale = finding.value.value_or(1);
  if (finding.code == "units") {
    const std::string of_a = format("{solve}--scale %g", 1 / scale),
                      of_b = format("{solve}--scale-b %g", scale);
    const char longer = scale < 1 ? 'b' : 'a';
    std::string cure = scale < 1 ? of_b : of_a;
    // nothing goes as slowly as the longer one would: the shorter one is likelier to be in kilometres
    if (either)
      cure = format("%s, or %s if it is the lengths of %s that are wrong.", (scale < 1 ? of_a : of_b).c_str(),
                    cure.c_str(), mark(longer));
    say(finding,
        either ? std::string("The lengths of {a} or of {b} are not in metres")
               : format("The lengths of %s are not in metres", mark(longer)),
        std::move(cure), format(": those of {b} times %g fit those of {a}.", scale));
  } else {
    say(finding, format("The lengths of {b} times %.4g fit those of {a}", scale),
        "{solve}--scale-b auto, or --scale auto if it is the lengths of {a} that are wrong.",
        format(": %s.", fits(finding).c_str()));
  }
  return finding;
}

Finding worded_clock(Finding finding, const ClockModel& clock) {
  if (finding.code == "clock_drift") {
    say(finding,
        format("The clocks drift apart: {b}'s stamps need %+.4f s in the middle of the drive and "
               "%+.0f us more each second",
               clock.offset, 1e6 * clock.rate),
        "Synchronise the clocks; for a short drive {solve}--time-offset auto",
        format("; %s.", fits(finding).c_str()));
  } else {
    say(finding, format("The clocks differ: %+.4f s added to the stamps of {b} fits", clock.offset),
        "{solve}--time-offset auto", format("; %s.", fits(finding).c_str()));
  }
  return finding;
}

}  // namespace egocal::detail
