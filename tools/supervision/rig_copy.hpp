// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/bus/rig.hpp"

namespace egocal::tools {

/// The text of a rig file as it was read once, for processes that are started from here at any later time:
/// the file may be edited or removed meanwhile, or be a pipe. It is in memory and goes with the last of them.
class RigCopy {
 public:
  /// Throws Error, which names the file, where it cannot be read or is no rig.
  explicit RigCopy(const std::string& file);
  ~RigCopy();
  RigCopy(const RigCopy&) = delete;
  RigCopy& operator=(const RigCopy&) = delete;

  const bus::Rig& rig() const { return rig_; }
  /// A file name for programs that inherit our open files.
  std::string name_for_programs() const;

 private:
  bus::Rig rig_;
  int fd_ = -1;
};

}  // namespace egocal::tools
