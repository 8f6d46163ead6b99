// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/replacing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/explanations/late_positions.hpp"
#include "diagnosis/explanations/not_a_move.hpp"
#include "diagnosis/explanations/turned_lever_arm.hpp"
#include "diagnosis/explanations/turning_scale.hpp"
#include "diagnosis/explanations/unlike_columns.hpp"
#include "diagnosis/mount/large_move.hpp"
#include "diagnosis/mount/mount.hpp"

namespace egocal::detail {

namespace {

std::vector<Finding>::const_iterator certain_axes_of_both(const std::vector<Finding>& findings) {
  return std::find_if(findings.begin(), findings.end(),
                      [](const Finding& one) { return one.certain && one.code == "axes_both"; });
}

}  // namespace

std::vector<Finding> wrong_stream(const Evidence& evidence, const DiagnosisOptions& options) {
  std::vector<Finding> best = turning_scale(evidence.instants, evidence.given.explained, options);
  for (std::optional<Finding> finding :
       {turned_lever_arm(evidence.instants, evidence.given.explained, options),
        late_positions(evidence.instants, evidence.given.explained, options)})
    if (finding && (best.empty() || best.front().improvement < finding->improvement))
      best = {*std::move(finding)};
  std::vector<Finding> columns = unlike_columns(evidence, options);
  if (!columns.empty() && (best.empty() || best.front().improvement < columns.front().improvement))
    best = std::move(columns);
  return best;
}

bool replace_by_large_move(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                           const DiagnosisOptions& options, std::vector<Finding>& findings) {
  if (answered.problem.mode == Mode::planar) return false;
  for (const Finding& finding : findings)
    if (finding.certain && !finding.code.starts_with("axes_") && !finding.code.starts_with("clock_"))
      return false;
  std::optional<Finding> move = large_move(evidence.instants, evidence.stride, options);
  if (!move) return false;
  for (const Finding& finding : findings)
    if (finding.code != "inverted_both" && finding.improvement > move->improvement) return false;
  const std::vector<PoseReading> of_both = readings_of_both(findings);
  // its time is more exact where it is small enough for the linear test
  findings = moved_mount(evidence.instants, answered, options).findings;
  if (!one_move(findings)) findings = {*std::move(move)};
  findings = moves_or_else(std::move(findings), pairing, evidence, answered, of_both, options);
  return true;
}

bool replace_by_moves(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                      const DiagnosisOptions& options, std::vector<Finding>& findings) {
  if (answered.problem.mode == Mode::planar) return false;
  const auto axes = certain_axes_of_both(findings);
  if (axes == findings.end()) return false;
  std::vector<Finding> moves = moved_mount(evidence.instants, answered, options).findings;
  if (moves.empty() || std::exp(gain_of_parts(evidence, moves, options)) <= axes->improvement) return false;
  moves = moves_or_else(std::move(moves), pairing, evidence, answered, readings_of_both(findings), options);
  if (moves.empty()) return false;
  findings = std::move(moves);
  return true;
}

bool replace_by_wrong_stream(const Evidence& evidence, const Answered& answered,
                             const DiagnosisOptions& options, std::vector<Finding>& findings) {
  if (answered.problem.mode == Mode::planar) return false;
  const auto of_scale = [](const Finding& one) {
    return one.certain && (one.code == "scale" || one.code == "units");
  };
  // exchanged columns in another unit have two findings already
  const auto other = [&](const Finding& one) { return one.certain && !of_scale(one); };
  if (std::any_of(findings.begin(), findings.end(), of_scale) &&
      std::none_of(findings.begin(), findings.end(), other))
    if (const std::vector<Finding> columns = unlike_columns(evidence, options);
        !columns.empty() && columns.front().certain) {
      std::erase_if(findings, of_scale);
      findings.insert(findings.begin(), columns.begin(), columns.end());
      return true;
    }
  const auto axes = certain_axes_of_both(findings);
  if (axes == findings.end()) return false;
  std::vector<Finding> wrong = wrong_stream(evidence, options);
  if (wrong.empty() || wrong.front().improvement <= axes->improvement) return false;
  findings = std::move(wrong);
  return true;
}

}  // namespace egocal::detail
