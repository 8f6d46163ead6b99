// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "io/extrinsic/words.hpp"

namespace egocal::detail {

std::string yaml_text(const ExtrinsicWords& words) {
  const Pose& T = words.T;
  std::string text = "# " + words.direction + "\n# " + words.verdict + "\n# " + words.lengths +
                     ", radians, quaternion order w x y z\n";
  text += "parent: " + yaml_word(words.a) + "\nchild: " + yaml_word(words.b) + "\n";
  text += "translation: [" + joined(T.translation, ", ") + "]\n";
  text += "rotation_wxyz: [" + joined(wxyz(T.rotation), ", ") + "]\n";
  text += "roll_pitch_yaw: [" + joined(roll_pitch_yaw(T.rotation), ", ") + "]\n";
  text += "matrix:\n" + matrix_rows(T, "  ");
  if (words.extrinsic.stddev) {
    text += "stddev:  # x y z roll pitch yaw in " + words.a + "; .inf: not known from the motions\n";
    for (const double s : *words.extrinsic.stddev)
      text += "  - " + (std::isfinite(s) ? exact(s) : std::string(std::isnan(s) ? ".nan" : ".inf")) + "\n";
  }
  text += "verdict: " + (words.extrinsic.verdict.empty() ? "null" : words.extrinsic.verdict) + "\n";
  if (!words.extrinsic.reason.empty()) text += "reason: " + in_quotes(words.extrinsic.reason) + "\n";
  const std::vector<std::string> not_shown = not_observable(words.extrinsic);
  text += "not_observable: " + list_in_quotes(not_shown) +
          (not_shown.empty() ? ""
                             : "  # of " + frame_name(backing_frame(words.extrinsic)) +
                                   ": these numbers are no measurement") +
          "\n";
  if (const auto nominal = directions_with(words.extrinsic, Backing::nominal); !nominal.empty())
    text += "from_nominal: " + list_in_quotes(nominal) + "\n";
  text += std::string("usable: ") + (words.extrinsic.usable ? "true" : "false") + "\n";
  text += std::string("certified: ") + (words.extrinsic.certified ? "true" : "false") + "\n";
  if (words.extrinsic.scale) {
    const NamedScale& scale = *words.extrinsic.scale;
    text += "scale:  # lengths of this sensor, multiplied by the value, are those of the other one" +
            std::string(scale.metres ? ", metres" : "; the translation is in the unit of those") + "\n";
    text += "  sensor: " + yaml_word(frame_name(scale.sensor)) + "\n  value: " + exact(scale.value) + "\n";
    text += "  stddev: " + (std::isfinite(scale.stddev) ? exact(scale.stddev) : std::string(".inf")) + "\n";
    text += std::string("  certified: ") + (scale.certified ? "true" : "false") + "\n";
    if (scale.changes) text += "  changes: true  # along the drive: the value is the mean\n";
  }
  return text + "pairs: " + std::to_string(words.extrinsic.pairs) + "\n";
}

}  // namespace egocal::detail
