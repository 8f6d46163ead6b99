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
  /// In the file system. Throws Error as open_state_medium() does.
  SavedMemory(const std::string& file, const bus::Rig& rig, StateFile::Clock clock = boot_time,
              const StateOptions& options = {});

  /// Hands what is on disk to take, which throws Error where it cannot be its own. False: there is nothing,
  /// or it is refused.
  bool restore(const std::function<void(Memory)>& take);
  /// One line: why what was there is refused; empty: it is not.
  const std::string& refused() const { return file_.refused(); }
  /// Throws Error where the disk does not take it; the old content is then still there.
  void save(const Memory& memory);

 private:
  StateFile file_;
};

}  // namespace egocal::services
