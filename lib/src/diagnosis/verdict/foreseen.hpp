// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What is found before there is an answer.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/streams/awake_streams.hpp"
#include "egocal/diagnosis/foresee.hpp"

namespace egocal::detail {

/// What needs no answer.
struct Foreseen {
  const Trajectory &a, &b;
  PairingOptions pairing;
  DiagnosisOptions options;
  Evidence evidence;
  std::vector<Finding> findings{};  ///< about the streams, where there are enough motions
  /// Findings that a stream freezes at times. Where there are any, the streams and the evidence are those
  /// without its repeated poses.
  std::vector<Finding> frozen{};
  std::shared_ptr<const AwakeStreams> awake{};
  bool has_offset = false;
  std::optional<TimeOffset> offset{};  ///< offset_by_turning(), where it was looked for already
};

/// Gathers the evidence, checks the streams themselves, and looks for what else they may mean.
Foreseen foresee_streams(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                         const DiagnosisOptions& options);

/// Whether a finding says that a stream repeats its pose.
bool of_frozen_stream(const Finding& finding);

}  // namespace egocal::detail
