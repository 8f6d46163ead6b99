// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/pair/option_remedies.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::tools {

namespace {

/// Which streams an option inverts.
struct Inverted {
  bool a = false, b = false;
};

Inverted inverted_by(const CalibrationOptions& options) {
  return {options.read_a.invert, options.read_b.invert};
}

/// The cure of the finding that the poses of this stream are inverted.
std::string cure_of_inverted(char which, const Inverted& given) {
  const char rest = which == 'a' ? 'b' : 'a';
  if (which == 'a' ? given.a : given.b) return fmt::format("leave out --invert-{}", which);
  // both inverted, or none: without noise the motions do not tell which
  if (given.a || given.b)
    return fmt::format("leave out --invert-{}, or give --invert-{} as well", rest, which);
  return fmt::format("--invert-{}", which);
}

void word_inverted(Finding& finding, char which, const Inverted& given) {
  FindingWords words = finding.words;
  const char rest = which == 'a' ? 'b' : 'a';
  if (which == 'a' ? given.a : given.b)
    words.claim = fmt::format(
        "The poses of {} are sensor-to-world already, --invert-{} makes them world-to-sensor", which, which);
  else if (given.a || given.b)
    words.claim =
        fmt::format("The poses of {} are inverted by --invert-{}, those of {} are not", rest, rest, which);
  words.cure = cure_of_inverted(which, given);
  say(finding, std::move(words));
}

void word_inverted_both(Finding& finding, const Inverted& given) {
  FindingWords words = finding.words;
  std::string before = "Make sure that the poses are sensor-to-world; otherwise ";
  if (given.a && given.b) {
    words.claim = finding.certain ? "The poses of both streams are sensor-to-world already"
                                  : "If the poses of both streams are sensor-to-world already";
    words.cure = "leave out --invert-a and --invert-b";
    before = "Make sure that the poses are world-to-sensor; otherwise ";
  } else {
    words.cure =
        given.a ? "leave out --invert-a and give --invert-b" : "leave out --invert-b and give --invert-a";
  }
  if (!finding.certain) words.cure = before + words.cure;
  say(finding, std::move(words));
}

/// Whether an option exchanges the columns of quaternions that were right: the two orders undo each other.
bool undone_by(const Finding& finding, QuaternionOrder given) {
  const bool to_xyzw = finding.words.cure.find("xyzw") != std::string::npos;
  return given == (to_xyzw ? QuaternionOrder::wxyz : QuaternionOrder::xyzw);
}

void word_quaternion_order(Finding& finding, char which, QuaternionOrder given) {
  if (!undone_by(finding, given)) return;
  FindingWords words = finding.words;
  words.claim = fmt::format(
      "The quaternions of {{{}}} are in the order of its format, --quaternion-order-{} exchanges their "
      "columns",
      which, which);
  const bool inverted = words.cure.find("--invert-") != std::string::npos;
  words.cure = fmt::format("leave out --quaternion-order-{}", which) +
               (inverted ? fmt::format(" and give --invert-{}", which) : "");
  say(finding, std::move(words));
}

void word_quaternion_order_both(Finding& finding, QuaternionOrder of_a, QuaternionOrder of_b) {
  if (!undone_by(finding, of_a) || !undone_by(finding, of_b)) return;
  FindingWords words = finding.words;
  words.claim = "The quaternions of both streams are in the order of their formats";
  words.cure = "leave out --quaternion-order-a and --quaternion-order-b";
  say(finding, std::move(words));
}

/// Words the cure of a wrong scale where the factor was given: another one takes its place.
void word_scale(Finding& finding, const CalibrationOptions& options, const std::string& option) {
  if (!finding.value || !(*finding.value > 0)) return;
  const bool of_a = options.scale_side == Side::a;
  const double right = of_a ? options.scale / *finding.value : options.scale * *finding.value;
  constexpr double none = 1e-3;  // limit: a factor that is one
  const std::string cure = std::abs(right - 1) < none
                               ? fmt::format("leave out {}", option)
                               : fmt::format("{} {:.4g} or {} auto, in place of {} {:.10g}", option, right,
                                             option, option, options.scale);
  say(finding, finding.words.claim, cure, finding.words.evidence);
}

/// Rewords findings, and the reason of the verdict where it is one of them.
template <class Word>
void reword(Calibration& calibration, const Word& word) {
  for (Finding& finding : calibration.findings) {
    const bool is_reason = calibration.reason == finding.message;
    word(finding);
    if (is_reason) calibration.reason = finding.message;
  }
}

/// Words the cure of a wrong scale where the factor was looked for, and lies beyond what was searched.
void word_scale_beyond_range(Finding& finding, const CalibrationOptions& options, const std::string& option,
                             double searched) {
  if (!finding.value || !(*finding.value > 0)) return;
  const bool of_a = options.scale_side == Side::a;
  const double right = of_a ? searched / *finding.value : searched * *finding.value;
  say(finding, finding.words.claim,
      fmt::format("{} {:.4g}, or multiply the lengths of {} by {:.4g} before {} auto", option, right,
                  of_a ? "{a}" : "{b}", searched, option),
      finding.words.evidence);
}

void word_scale_of(Finding& finding, const CalibrationOptions& options, const std::string& option,
                   const Calibration& calibration) {
  if (finding.code != "scale" && finding.code != "units") return;
  if (!options.estimate_scale && options.scale != 1) word_scale(finding, options, option);
  if (calibration.scale && calibration.scale->at_limit)
    word_scale_beyond_range(finding, options, option, calibration.scale->scale);
}

void word_orders(Finding& finding, const CalibrationOptions& options) {
  const QuaternionOrder a = options.read_a.quaternion_order, b = options.read_b.quaternion_order;
  if (finding.code == "quaternion_order_a") word_quaternion_order(finding, 'a', a);
  if (finding.code == "quaternion_order_b") word_quaternion_order(finding, 'b', b);
  if (finding.code == "quaternion_order_both") word_quaternion_order_both(finding, a, b);
}

}  // namespace

void word_for_options(const CalibrationOptions& options, const std::string& scale_option,
                      Calibration& calibration) {
  const Inverted given = inverted_by(options);
  reword(calibration, [&](Finding& finding) {
    word_scale_of(finding, options, scale_option, calibration);
    word_orders(finding, options);
    if (!given.a && !given.b) return;
    if (finding.code == "inverted_a") word_inverted(finding, 'a', given);
    if (finding.code == "inverted_b") word_inverted(finding, 'b', given);
    if (finding.code == "inverted_both") word_inverted_both(finding, given);
  });
}

void word_for_options_of_samples(const CalibrationOptions& options, const std::string& scale_option,
                                 bool eye_to_hand, Calibration& calibration) {
  const Inverted given = inverted_by(options);
  reword(calibration, [&](Finding& finding) {
    if (eye_to_hand && finding.code == "inverted_a")
      say(finding,
          fmt::format(
              "Without --eye-to-hand the squared residuals are {:.3g} times smaller: the camera is on "
              "the hand, or the poses of {{a}} are base-to-hand",
              finding.improvement),
          "leave out --eye-to-hand", finding.words.evidence);
    if (eye_to_hand) return;
    word_scale_of(finding, options, scale_option, calibration);
    word_orders(finding, options);
    if (!given.a && !given.b) return;
    for (const char which : {'a', 'b'}) {
      if (finding.code != std::string("inverted_") + which) continue;
      FindingWords words = finding.words;
      words.cure = cure_of_inverted(which, given);
      say(finding, std::move(words));
    }
  });
}

}  // namespace egocal::tools
