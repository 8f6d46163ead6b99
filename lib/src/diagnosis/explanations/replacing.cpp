// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/replacing.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "diagnosis/explanations/contents/other_contents.hpp"
#include "diagnosis/explanations/contents/turned_lever_arm.hpp"
#include "diagnosis/explanations/lengths/not_a_move.hpp"
#include "diagnosis/explanations/lengths/unlike_columns.hpp"
#include "diagnosis/explanations/times/late_column.hpp"
#include "diagnosis/explanations/turning/turning_drift.hpp"
#include "diagnosis/explanations/turning/turning_scale.hpp"
#include "diagnosis/mount/exchanged_streams.hpp"
#include "diagnosis/mount/large_move.hpp"
#include "diagnosis/mount/mount.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

std::vector<Finding>::const_iterator certain_axes_of_both(const std::vector<Finding>& findings) {
  return std::find_if(findings.begin(), findings.end(),
                      [](const Finding& one) { return one.certain && one.code == "axes_both"; });
}

/// The findings of which the best one explains more; both where the best ones explain about as much.
std::vector<Finding> more_likely(std::vector<Finding> first, std::vector<Finding> second, double alike) {
  if (first.empty()) return second;
  if (second.empty()) return first;
  const double gain = std::log(second.front().improvement / first.front().improvement);
  if (gain > alike) return second;
  if (gain >= -alike) first.insert(first.end(), second.begin(), second.end());
  return first;
}

double best_improvement(const std::vector<Finding>& findings) {
  double best = 0;
  for (const Finding& finding : findings) best = std::max(best, finding.improvement);
  return best;
}

bool of_reading_or_clock(const Finding& finding) {
  const std::string_view code = finding.code;
  return code.starts_with("axes_") || code.starts_with("quaternion_order_") || code == "inverted_a" ||
         code == "inverted_b" || code.starts_with("clock_");
}

/// Words the move of streams that are exchanged from then on.
Finding exchanged(Finding move) {
  say(move,
      format(
          "From about %.1f s after the start on, the mounting is the inverse of the one before: {a} and {b} "
          "are exchanged from then on",
          *move.time),
      format("Exchange the poses of {a} and {b} from %.1f s on, or calibrate the drive before and after that "
             "separately.",
             *move.time),
      ", as where topics or files were swapped.");
  return move;
}

}  // namespace

const std::vector<Finding>& WrongStream::contents() {
  if (!contents_)
    contents_ = mode_ == Mode::planar ? std::vector<Finding>() : other_contents(evidence_, options_);
  return *contents_;
}

const std::vector<Finding>& WrongStream::columns() {
  if (!columns_)
    columns_ = mode_ == Mode::planar ? std::vector<Finding>() : unlike_columns(evidence_, options_);
  return *columns_;
}

const std::optional<LateOfEither>& WrongStream::late() {
  if (!late_)
    late_ = mode_ == Mode::planar
                ? std::nullopt
                : best_late_positions(evidence_.instants, evidence_.given.explained, options_);
  return *late_;
}

const std::vector<Finding>& WrongStream::late_column() {
  if (!late_column_)
    late_column_ = mode_ == Mode::planar
                       ? std::vector<Finding>()
                       : detail::late_column(evidence_.instants, evidence_.given.explained, options_);
  return *late_column_;
}

const std::vector<Finding>& WrongStream::best() {
  if (best_) return *best_;
  best_.emplace();
  if (mode_ == Mode::planar) return *best_;
  const Explained& given = evidence_.given.explained;
  std::vector<Finding> best = turning_scale(evidence_.instants, given, options_);
  const auto take = [&best](std::vector<Finding> found) {
    if (!found.empty() && (best.empty() || best_improvement(best) < best_improvement(found)))
      best = std::move(found);
  };
  take(turning_drift(evidence_.instants, given, options_));
  if (std::optional<Finding> arm = turned_lever_arm(evidence_.instants, given, options_))
    take({*std::move(arm)});
  const bool by_a_row = !contents().empty() && contents().front().code.starts_with("late_positions_");
  if (!by_a_row && late() && certain(*late(), options_)) take(worded(*late()));
  take(late_column());
  take(columns());
  // small angles times a factor are nearly those of rotation vectors: both are named where both fit
  return *(best_ = more_likely(std::move(best), contents(), options_.alike));
}

bool replace_by_large_move(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                           const DiagnosisOptions& options, WrongStream& wrong,
                           std::vector<Finding>& findings) {
  if (answered.problem.mode == Mode::planar) return false;
  for (const Finding& finding : findings)
    if (finding.certain && !of_reading_or_clock(finding)) return false;
  std::optional<Finding> move = large_move(evidence.instants, evidence.stride, options);
  if (!move) return false;
  for (const Finding& finding : findings)
    if (finding.code != "inverted_both" && finding.improvement > move->improvement) return false;
  if (!wrong.contents().empty() && wrong.contents().front().improvement > move->improvement) {
    findings = wrong.contents();
    return true;
  }
  if (move->time && exchanged_streams(evidence.given.explained.motions, *move->time, options)) {
    findings = {exchanged(*std::move(move))};
    return true;
  }
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

void replace_by_contents(const DiagnosisOptions& options, WrongStream& wrong,
                         std::vector<Finding>& findings) {
  if (findings.empty() || !std::all_of(findings.begin(), findings.end(), [](const Finding& one) {
        return of_reading_or_clock(one) || one.code == "scale" || one.code == "units";
      }))
    return;
  if (std::none_of(findings.begin(), findings.end(), of_reading_or_clock)) return;
  findings =
      more_likely(std::move(findings), more_likely(wrong.contents(), wrong.columns(), 0), options.alike);
}

bool replace_by_wrong_stream(WrongStream& wrong, std::vector<Finding>& findings) {
  const auto of_scale = [](const Finding& one) {
    return one.certain && (one.code == "scale" || one.code == "units");
  };
  // exchanged columns in another unit have two findings already
  const auto other = [&](const Finding& one) { return one.certain && !of_scale(one); };
  if (std::any_of(findings.begin(), findings.end(), of_scale) &&
      std::none_of(findings.begin(), findings.end(), other))
    if (const std::vector<Finding>& columns = wrong.columns();
        !columns.empty() && columns.front().code.starts_with("axes_")) {
      std::erase_if(findings, of_scale);
      findings.insert(findings.begin(), columns.begin(), columns.end());
      return true;
    }
  const auto axes = certain_axes_of_both(findings);
  if (axes == findings.end()) return false;
  if (wrong.best().empty() || wrong.best().front().improvement <= axes->improvement) return false;
  findings = wrong.best();
  return true;
}

}  // namespace egocal::detail
