// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What a study found out drive by drive, in a file that later runs continue: hours of driving add up.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "support/random_motion.hpp"

namespace egocal::bench {

/// One line a drive: its kind, its number among those, and what the study found out, in the study's own
/// words.
class DriveRecord {
 public:
  /// path: empty keeps no record. settings: the first line of the file; ends the program with exit code 2
  /// where the file has others.
  DriveRecord(const std::string& program, const std::string& path, const std::string& settings);

  /// What an earlier run found out; null: nothing yet.
  const std::string* known(const std::string& kind, int index) const;

  /// Writes the line at once: a run that is stopped loses no drive.
  void add(const std::string& kind, int index, const std::string& outcome);

 private:
  std::map<std::pair<std::string, int>, std::string> known_;
  std::ofstream out_;
};

/// Random numbers of one drive, whichever others are run.
testing::Random random_of_drive(std::uint64_t seed, std::size_t kind, int index);

}  // namespace egocal::bench
