// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/drives/fault_of_drive.hpp"

#include <fmt/format.h>

#include <utility>

#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::tools {

namespace {

/// The finding that the verdict is about, otherwise the most important certain one. Of a contradictory drive
/// it may be open which reading is right, not that the drive is wrong.
const Finding* main_fault(const Calibration& alone) {
  const Finding* first = nullptr;
  for (const Finding& finding : alone.findings) {
    if (finding.time || finding.code == "mount_moved") continue;
    const bool is_reason = finding.message == alone.reason;
    if (is_reason && (finding.certain || alone.verdict == Verdict::contradictory)) return &finding;
    if (finding.certain && !first) first = &finding;
  }
  return first;
}

void word_for_drive(Finding& finding, const std::string& begin, std::size_t drive) {
  FindingWords words = finding.words;
  if (words.claim.empty()) words.claim = finding.message;
  if (words.cure.empty()) words.cure = finding.remedy;
  words.claim = begin + words.claim;
  words.scope =
      fmt::format("Correct the files of drive {}, or leave it out. By itself: ", drive + 1) + words.scope;
  say(finding, std::move(words));
}

}  // namespace

std::optional<Finding> fault_of_drive(const Drives& drives, std::size_t drive, const Calibration& alone) {
  const Finding* const fault = main_fault(alone);
  if (!fault) return std::nullopt;
  Finding finding = *fault;
  word_for_drive(finding, fmt::format("Drive {} ({}) differs: ", drive + 1, drives.name(drive)), drive);
  return finding;
}

OwnFault own_fault_of_drive(const Drives& drives, std::size_t drive, const Calibration& alone) {
  const std::string begin = fmt::format("Drive {} ({}) by itself: ", drive + 1, drives.name(drive));
  OwnFault fault{begin + alone.reason, std::nullopt};
  for (const Finding& finding : alone.findings) {
    if (finding.message != alone.reason) continue;
    fault.finding = finding;
    fault.finding->time.reset();
    word_for_drive(*fault.finding, begin, drive);
    fault.reason = fault.finding->message;
    break;
  }
  return fault;
}

}  // namespace egocal::tools
