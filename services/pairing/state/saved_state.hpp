// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pairing/accumulation.hpp"
#include "pairing/state/archive.hpp"
#include "pairing/state/state_file.hpp"

namespace egocal::services {

/// Keeps an Accumulation on disk: a snapshot, and every input since then.
class SavedState {
 public:
  /// Throws Error as StateFile does.
  SavedState(const std::string& file, const bus::Rig& rig);

  /// What is on disk, with all inputs applied; a new one where there is nothing or it is refused. Takes a
  /// snapshot, so that the next restart is quick. settled: see Accumulation::settle().
  Accumulation restore();
  bool restored() const { return restored_; }
  /// One line: why what was there is refused; empty: it is not.
  const std::string& refused() const { return file_.refused(); }

  /// Takes note of an input that is being applied.
  void note(const Input& input);
  /// Everything noted is on disk afterwards. Throws Error where that fails; a later snapshot heals it.
  void save(const Accumulation& accumulation);
  void snapshot(const Accumulation& accumulation);

 private:
  bus::Rig rig_;
  StateFile file_;
  Writer inputs_;
  bool restored_ = false;
  bool broken_ = false;  ///< inputs are missing in the file: only a snapshot helps
};

}  // namespace egocal::services
