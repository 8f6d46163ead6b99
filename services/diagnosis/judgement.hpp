// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "diagnosis/diagnosed_pair.hpp"
#include "diagnosis/diagnosing_options.hpp"
#include "diagnosis/judged_answer.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/bus/verdict.hpp"

namespace egocal::services {

/// The verdict on the newest problem of a pair.
struct Judgement {
  verdict_t verdict;                   ///< without its sender
  std::optional<JudgedAnswer> judged;  ///< empty: the answer is no good
  bool mount_moved = false;            ///< for certain
};

/// Judges the certified optimum of the pair's newest problem, which must be there, by the pair's poses.
/// scale: of the stream that has none of its own, else 1. Throws what the diagnosis throws.
Judgement judge(DiagnosedPair& pair, double scale, const bus::Rig& rig, const DiagnosingOptions& options);

}  // namespace egocal::services
