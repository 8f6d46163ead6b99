// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What was found is replaced by what explains more.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/explanations/late_positions.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/options.hpp"

namespace egocal::detail {

/// What may be wrong with one stream alone. Each is looked for when it is asked for, once: the evidence and
/// the options must still be there. In planar mode nothing is.
class WrongStream {
 public:
  WrongStream(const Evidence& evidence, Mode mode, const DiagnosisOptions& options)
      : evidence_(evidence), mode_(mode), options_(options) {}

  /// Other contents than poses in metres, and unlike columns.
  const std::vector<Finding>& contents();
  const std::vector<Finding>& columns();
  /// Certain or not; empty where there are too few motions.
  const std::optional<LateOfEither>& late();
  /// What explains most of these, late positions, a lever arm that was turned wrongly, and turning too far.
  const std::vector<Finding>& best();

 private:
  const Evidence& evidence_;
  Mode mode_;
  const DiagnosisOptions& options_;
  std::optional<std::vector<Finding>> contents_, columns_, best_;
  std::optional<std::optional<LateOfEither>> late_;
};

/// A mount that moved by much looks like other axes, another clock or another recording: it is named instead
/// of them where it explains more.
bool replace_by_large_move(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                           const DiagnosisOptions& options, WrongStream& wrong,
                           std::vector<Finding>& findings);

/// Axes that are turned alike in both files by any angle explain a part of what a mount that moved does, or
/// of one that fell back: the moves are named instead where they explain more.
bool replace_by_moves(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                      const DiagnosisOptions& options, std::vector<Finding>& findings);

/// Other readings and clocks of streams that hold something else than poses explain a part of their motions:
/// what explains more of them is named instead, and besides where it explains as much.
void replace_by_contents(const DiagnosisOptions& options, WrongStream& wrong, std::vector<Finding>& findings);

/// The same of what one stream alone explains more of than axes that are wrong in both, and of unlike columns
/// that look like another scale.
bool replace_by_wrong_stream(WrongStream& wrong, std::vector<Finding>& findings);

}  // namespace egocal::detail
