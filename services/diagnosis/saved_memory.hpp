// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "diagnosis/memory.hpp"
#include "egocal/bus/rig.hpp"
#include "state/state_file.hpp"

namespace egocal::services {

/// Keeps a Memory on disk, whole each time.
class SavedMemory {
 public:
  /// Keeps the memory in a file of this name. Throws Error as open_state_medium() does.
  SavedMemory(const std::string& file, const bus::Rig& rig, StateFile::Clock clock = boot_time,
              const StateOptions& options = {});

  /// Passes the saved memory to `take`, which throws Error if it cannot be its own. False: there is none, or
  /// it was refused.
  bool restore(const std::function<void(Memory)>& take);
  /// One line: why what was there is refused; empty: it is not.
  const std::string& refused() const { return file_.refused(); }
  /// Throws Error if the disk refuses it; the old content is then still there.
  void save(const Memory& memory);

 private:
  StateFile file_;
};

}  // namespace egocal::services
