// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace egocal::tools {

/// The state file through which a pairing process hands what it has accumulated to the one that takes its
/// place while `egocal up` runs: pairing-N.state in the folder of the outputs, under a name of its own. It is
/// owned by a lock, which ends with its process in whatever container that runs.
class PassingState {
 public:
  /// Throws Error where nothing can be written in the folder.
  explicit PassingState(const std::string& folder);
  /// Leaves the state: only discard() removes it.
  ~PassingState();
  PassingState(const PassingState&) = delete;
  PassingState& operator=(const PassingState&) = delete;

  const std::string& file() const { return file_; }
  /// The state file of the diagnosis process that belongs to a state file of pairing. It is beside that file,
  /// whatever that is called: one goes with the other.
  static std::string of_diagnosis(const std::string& file) { return file + ".diagnosis"; }
  void discard();

  /// States whose command did not end as it should: killed, or the machine was. Oldest first.
  static std::vector<std::string> left_behind(const std::string& folder);

 private:
  std::string file_;
  int owner_ = -1;
};

}  // namespace egocal::tools
