// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What was found is replaced by what explains more.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/explanations/times/late_positions.hpp"
#include "egocal/diagnosis/diagnose.hpp"
#include "egocal/pairing/options.hpp"

namespace egocal::detail {

/// Faults of one stream alone. Each kind is searched for once, when it is first asked for, so the evidence
/// and the options must outlive this object. In planar mode nothing is searched for.
class WrongStream {
 public:
  WrongStream(const Evidence& evidence, Mode mode, const DiagnosisOptions& options)
      : evidence_(evidence), mode_(mode), options_(options) {}

  /// Contents other than poses in metres; and columns in unlike units.
  const std::vector<Finding>& contents();
  const std::vector<Finding>& columns();
  /// Late positions, certain or not; empty if there are too few motions.
  const std::optional<LateOfEither>& late();
  /// Findings of one coordinate that is late.
  const std::vector<Finding>& late_column();
  /// The fault that explains most: contents, columns, late positions or one late coordinate, a lever arm that
  /// was turned wrongly, or turns that are too large.
  const std::vector<Finding>& best();

 private:
  const Evidence& evidence_;
  Mode mode_;
  const DiagnosisOptions& options_;
  std::optional<std::vector<Finding>> contents_, columns_, late_column_, best_;
  std::optional<std::optional<LateOfEither>> late_;
};

/// Replaces findings of other axes, another clock or another recording by a large move of the mount if that
/// explains more: such a move looks like each of them. Returns whether it did.
bool replace_by_large_move(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                           const DiagnosisOptions& options, WrongStream& wrong,
                           std::vector<Finding>& findings);

/// Replaces axes that are turned alike in both files by moves of the mount if those explain more: such axes
/// explain a part of one move, and of a move and the way back. Returns whether it did.
bool replace_by_moves(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                      const DiagnosisOptions& options, std::vector<Finding>& findings);

/// Replaces other readings and clocks by other contents of a stream (no poses in metres) if those explain
/// more of its motions. If they explain as much, both are named.
void replace_by_contents(const DiagnosisOptions& options, WrongStream& wrong, std::vector<Finding>& findings);

/// Likewise replaces axes that are wrong in both streams by a fault of one stream, and another scale by
/// columns in unlike units.
bool replace_by_wrong_stream(WrongStream& wrong, std::vector<Finding>& findings);

}  // namespace egocal::detail
