// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "egocal/cli/cli.hpp"
#include "egocal/io/recording.hpp"

namespace egocal::tools {

/// What the files themselves do not say, as typed: for both files, and for one alone.
struct ReadingOptions {
  ReadOptions both, a, b;

  /// The options of file A or B: what was typed for it alone, else for both.
  ReadOptions of_a() const;
  ReadOptions of_b() const;
};

/// Refuses them where no file of poses is read: `instead` is what takes its place, such as "--log".
void refuse_reading_options(const ReadingOptions& options, const char* instead);

/// Adds --times, --columns, --rate and --strict. The struct must exist until the command has run.
void add_reading_options(cli::App command, ReadOptions& options);

/// The same and --times-a, --times-b, --columns-a, --columns-b.
void add_reading_options(cli::App command, ReadingOptions& options);

}  // namespace egocal::tools
