// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pairing/accumulation.hpp"
#include "state/archive.hpp"
#include "state/state_file.hpp"

namespace egocal::services {

/// Keeps an Accumulation on disk: a snapshot, and every input since then.
class SavedState {
 public:
  /// Keeps the state in a file of this name. Throws Error as open_state_medium() does.
  SavedState(const std::string& file, const bus::Rig& rig, StateFile::Clock clock = boot_time,
             const StateOptions& options = {});
  SavedState(std::unique_ptr<StateMedium> medium, const bus::Rig& rig, StateFile::Clock clock,
             const StateOptions& options = {});

  /// The saved state with all its inputs applied and settled (Accumulation::settle()); a new one if there is
  /// no state or it was refused. Writes a snapshot, so that the next restart is quick. If the disk refuses
  /// that snapshot, nothing is thrown; see not_saved().
  Accumulation restore();
  bool restored() const { return restored_; }
  /// One line: why what was there is refused; empty: it is not.
  const std::string& refused() const { return file_.refused(); }

  /// One line: why the snapshot of restore() could not be written; empty: it was.
  const std::string& not_saved() const { return not_saved_; }

  /// Takes note of an input that is being applied.
  void note(const Input& input);
  /// Writes everything noted to the disk. Throws Error if that fails; a later snapshot repairs it.
  void save(const Accumulation& accumulation);
  void snapshot(const Accumulation& accumulation);
  /// Whether everything noted is on the disk.
  bool complete() const { return !broken_ && inputs_.bytes().empty(); }

 private:
  StateOptions options_;
  bus::Rig rig_;
  StateFile file_;
  Writer inputs_;
  std::string not_saved_;
  bool restored_ = false;
  bool broken_ = false;  ///< inputs are missing in the file: only a snapshot helps
};

}  // namespace egocal::services
