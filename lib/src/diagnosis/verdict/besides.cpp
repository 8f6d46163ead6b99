// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/verdict/besides.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "diagnosis/explanations/lengths/not_a_move.hpp"
#include "diagnosis/explanations/times/late_positions.hpp"
#include "diagnosis/explanations/turning/askew_rotations.hpp"
#include "diagnosis/motions/robust_fit.hpp"
#include "diagnosis/verdict/far_off.hpp"
#include "egocal/diagnosis/certain_of_either.hpp"

namespace egocal::detail {

bool explains(const Finding& finding, const DiagnosisOptions& options) {
  // late stamps look like two frames, and hide neither a move nor a scale
  const bool may_be_beside = finding.code == "inverted_both" || finding.code.starts_with("mixed_frames_");
  return certain_of_either(finding) || finding.code == "samples" ||
         (!may_be_beside && finding.improvement > options.overwhelming);
}

void name_wrong_scale(const Evidence& evidence, const PairingOptions& pairing, const Answered& answered,
                      const DiagnosisOptions& options, std::vector<Finding>& findings) {
  for (const Finding& finding : findings)
    if (explains(finding, options) || finding.code == "mount_moved") return;
  // right odometries differ, too; that counts where the answer is another one
  const bool small = std::abs(std::log(evidence.scaled.scale)) < options.scale_check.least;
  const bool another_answer = far_off(evidence.scaled.explained.fit.T, answered, options) > 1;
  std::optional<Finding> scale;
  if (!small || another_answer) scale = wrong_scale(evidence, options);
  if (!scale && !small) scale = wrong_scale_of_drive(evidence, pairing, options);
  if (!scale) return;
  if (!scale->certain) {
    const bool named =
        std::any_of(findings.begin(), findings.end(), [](const Finding& one) { return one.code == "scale"; });
    if (another_answer && !named) findings.push_back(*std::move(scale));
    return;
  }
  // the same with less certainty, and what its motions were taken for
  std::erase_if(findings, [](const Finding& one) {
    return one.code == "scale" || one.code == "units" || one.code == "inverted_both";
  });
  findings.push_back(*std::move(scale));
}

void replace_by_changing_scale(const Evidence& evidence, const PairingOptions& pairing,
                               const Answered& answered, const DiagnosisOptions& options,
                               std::vector<Finding>& findings) {
  const auto one_scale = [](const Finding& one) { return one.certain && one.code == "scale"; };
  const auto scale = std::find_if(findings.begin(), findings.end(), one_scale);
  if (scale == findings.end()) return;
  for (const Finding& finding : findings)
    if (!one_scale(finding) && explains(finding, options)) return;
  std::optional<Finding> changing = changing_scale(pairing, evidence, answered, options);
  const double gain = compare(evidence.given.explained, evidence.scaled.explained).gain;
  if (changing && changing->certain && std::log(changing->improvement) - gain > options.gain)
    *scale = *std::move(changing);
}

void name_askew_rotations(const Evidence& evidence, const Answered& answered, const DiagnosisOptions& options,
                          std::vector<Finding>& findings) {
  if (answered.problem.mode == Mode::planar) return;
  for (const Finding& finding : findings)
    if ((certain_of_either(finding) && !finding.code.starts_with("undersampled_")) ||
        finding.code == "mount_moved" || finding.code == "scale_change" || finding.code == "samples" ||
        finding.code == "odometry")
      return;
  if (std::optional<Finding> askew = askew_rotations(evidence.instants, evidence.stride, answered, options))
    findings.push_back(*std::move(askew));
}

}  // namespace egocal::detail
