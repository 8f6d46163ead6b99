// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "supervision/reports.hpp"
#include "supervision/restarts.hpp"

namespace egocal::tools {

/// The outputs and state files of supervised programs. Once a program has started, a folder that is gone or
/// full ends nothing: it is made again, or the program does without, which is reported.
class ProgramFiles {
 public:
  /// folder: of the outputs; empty: they go where ours goes.
  ProgramFiles(std::string folder, Reports& reports) : folder_(std::move(folder)), reports_(reports) {}

  /// A file descriptor for the output of a program, to be closed by the caller; -1: where ours goes. Throws
  /// Error if it cannot be opened before its first start.
  int open_output_of(const Program& program, bool has_started);
  /// The command line, without its state file where the folder is gone and cannot be made: a process that
  /// cannot lock its state does not begin, and the drive goes on.
  std::vector<std::string> command_of(const Program& program, bool has_started);
  /// The output file of a program, where the folder's name is not empty.
  std::string output_file(const Program& program) const { return folder_ + "/" + program.name + ".out"; }
  /// The last line that a program wrote; empty: not known.
  std::string last_line_of(const Program& program) const;

 private:
  bool kept(const Program& program) const { return !folder_.empty() && !program.foreground; }

  std::string folder_;
  Reports& reports_;
};

}  // namespace egocal::tools
