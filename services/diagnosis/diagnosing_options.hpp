// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>

#include "diagnosis/drive_sample.hpp"
#include "diagnosis/unseen.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::services {

struct DiagnosingOptions {
  /// Part of a core that diagnoses may take. The next diagnosis waits until the processor time of the last
  /// one is at most this part of the time since that began.
  double share = 0.04;
  /// A new answer farther from the judged one than this is judged once without waiting. In standard
  /// deviations stated with the judged answer. Without it a good verdict stood beside answers metres away for
  /// seconds. Study: docs/processes.md, "The diagnosis".
  double far_from_judged = 6;
  /// Announced before each diagnosis [s], which sends no heartbeat: as long as `egocal up` waits for a
  /// verdict at the end of a log (LastAnswersOptions). One takes a second at most on a core of its own;
  /// beside four processes that take the core, more than the 3 s after which a silent process counts as gone.
  std::chrono::seconds longest_silence{60};
  double least_distance = 1;  ///< [s] between two diagnoses, however quick
  /// A pair without a new problem for this time [s] is judged once without waiting, because the drive has
  /// ended.
  double idle = 0.6;
  /// Poses without a new problem are judged in steps of this [s]. If all motions are rejected, as after a
  /// sensor was lost, nothing else reports it. Shorter than a finding needs, much longer than a period of a
  /// sensor.
  double pose_step = 2;
  /// Chance of a false alarm of a moved mount in one diagnosis, and how long before its end [s] the drive
  /// must have shown the move (MountCheckOptions). An hour has 2,000 diagnoses. Study: docs/moves.md, "Live".
  double false_alarms = 4e-4;
  double shown_before = 2;
  /// Messages of one sensor that may wait while a diagnosis takes its time: ten seconds at 1 kHz, or a second
  /// of a log at full speed. Study: docs/processes.md, "The diagnosis".
  int queue_capacity = 10'000;
  DriveSampleOptions sample;
  UnseenOptions unseen;
  /// Time between two saved states [s], and the part of the time that saving may take. A slow disk is written
  /// to less often, and messages wait no longer than one save.
  double save_distance = 2;
  double save_share = 0.02;
  /// The diagnosis of the library; tests pass one that fails.
  using Diagnose = Diagnosis(const Trajectory& a, const Trajectory& b, const PairingOptions& pairing,
                             const Answered& answered, const DiagnosisOptions& options);
  std::function<Diagnose> diagnose = static_cast<Diagnose*>(&egocal::diagnose);
};

}  // namespace egocal::services
