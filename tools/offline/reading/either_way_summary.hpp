// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/io/stream_summary.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::tools {

/// Summarises a stream in both directions of time, in constant memory: rows that were written latest first
/// have their path and their rate, too.
class EitherWaySummariser {
 public:
  void add(const StampedPose& pose);
  /// Of the rows from the last to the first where most descend. Times and their order are those of the file.
  StreamSummary summary() const;

 private:
  StreamSummariser forward_, backward_;
};

}  // namespace egocal::tools
