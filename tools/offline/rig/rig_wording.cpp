// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/rig/rig_wording.hpp"

#include <fmt/format.h>

#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::tools {

namespace {

Terms terms_of(const RigWords& words) {
  return {words.name_a, words.name_b, {}};
}

/// The terms for what the rig file says of a pair: with the sensors in the order of the file.
Terms terms_of_file(const RigWords& words) {
  return words.listed_turned ? Terms{words.name_b, words.name_a, {}} : terms_of(words);
}

/// How well it fits, after a claim of the rig's own.
std::string evidence_of(const Finding& found, const RigWords& words) {
  return found.words.evidence.empty() ? "." : in_terms(found.words.evidence, terms_of(words));
}

void word_scale(const Finding& found, bool of_b, const RigWords& words, RigFinding& finding) {
  const double factor = of_b ? *found.value : 1 / *found.value;
  const std::string& name = of_b ? words.name_b : words.name_a;
  const std::string& other = of_b ? words.name_a : words.name_b;
  const double in_all = factor * (of_b ? words.scale_b : words.scale_a);
  finding.value = factor;
  finding.message = fmt::format("The lengths of {} times {:.4g} fit those of {}{}", name, factor, other,
                                evidence_of(found, words));
  finding.remedy =
      words.rig.empty()
          ? fmt::format(
                "Multiply the positions of {} by {:.4g}, or name the sensors in a rig file (--rig), "
                "with scale = {:.4g} for {}.",
                name, factor, factor, name)
          : fmt::format("In {}: scale = {:.4g} for {}.", words.rig, in_all, name);
  if (found.code == "units")
    finding.remedy +=
        fmt::format(" Or {:.4g} for {}, where it is that one's lengths that are wrong.", 1 / factor, other);
}

void word_clock_offset(const Finding& found, bool of_b, const RigWords& words, RigFinding& finding) {
  // streams are on one clock already: what is found is what they lack
  const double lacking = of_b ? *found.value : -*found.value;
  const double in_all = lacking + (of_b ? words.time_offset : -words.time_offset);
  const std::string& name = of_b ? words.name_b : words.name_a;
  finding.value = in_all;
  finding.message = fmt::format("The clocks differ: {:+.4f} s has to be added to the stamps of {}{}", in_all,
                                name, evidence_of(found, words));
  finding.remedy = words.offset_found  ? "Synchronise the clocks, or correct the stamps of " + name + "."
                   : words.rig.empty() ? "--time-offset auto"
                                       : fmt::format(
                                             "--time-offset auto, or time_offset = \"auto\" for the "
                                             "pairs of {} in {}.",
                                             name, words.rig);
}

/// Options that go with two streams are refused for rigs.
std::string cure(const Finding& found, const RigWords& words) {
  const std::string& code = found.code;
  const std::string one = code.ends_with("_a") ? words.name_a : code.ends_with("_b") ? words.name_b : "";
  const std::string whose = one.empty() ? words.name_a + " and " + words.name_b : one;
  if (code.starts_with("inverted_"))
    return found.certain ? "Give the inverse of each pose of " + whose + ": sensor to world."
                         : "Make sure that the poses of " + whose + " are sensor-to-world.";
  if (code.starts_with("quaternion_order_"))
    return "Give the quaternions of " + whose + " in the order that their format says." +
           (found.remedy.find("--invert-") != std::string::npos
                ? " Its poses are world-to-sensor: give the inverse of each."
                : "");
  if (code == "scale_change" && found.time)
    return "Calibrate " + words.name_a + " and " + words.name_b +
           " by themselves: solve A B --scale-b auto finds the factors, --scale auto where " + words.name_b +
           " is in metres.";
  if (code == "clock_drift") return "Synchronise the clocks; for a short drive --time-offset auto";
  if (code == "samples") return "Calibrate two of them at a time: solve A B --samples";
  if (code == "nominal") return remedy_in_terms(found, terms_of_file(words));
  if (code.starts_with("plane_") && !words.rig.empty())
    return "Correct the plane of " + whose + " in " + words.rig + ".";
  return found.words.cure.empty() ? found.remedy : in_terms(found.words.cure, terms_of(words));
}

}  // namespace

void word_for_rig(const Finding& found, std::optional<bool> of_b, const RigWords& words,
                  RigFinding& finding) {
  finding.value = found.value;
  // what holds of a part of the drives only has its own words
  const bool has_value = found.value && *found.value != 0 && found.words.scope.empty();
  if ((found.code == "scale" || found.code == "units") && has_value)
    return word_scale(found, of_b.value_or(found.code != "units" || *found.value < 1), words, finding);
  if (found.code == "clock_offset" && has_value)
    return word_clock_offset(found, of_b.value_or(true), words, finding);
  if (found.code == "clock_drift" && has_value && of_b && !*of_b) finding.value = -*found.value;
  finding.message = message_in_terms(found, terms_of(words));
  finding.remedy = in_terms(found.words.scope, terms_of(words)) + cure(found, words);
}

}  // namespace egocal::tools
