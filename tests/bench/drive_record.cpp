// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "drive_record.hpp"

#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace egocal::bench {

DriveRecord::DriveRecord(const std::string& program, const std::string& path, const std::string& settings) {
  if (path.empty()) return;
  std::ifstream in(path);
  std::string line;
  const bool continues = static_cast<bool>(std::getline(in, line));
  if (continues && line != settings) {
    std::fprintf(stderr, "%s: %s: has other settings: %s\n", program.c_str(), path.c_str(), line.c_str());
    std::exit(2);
  }
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string kind, outcome;
    int index = 0;
    if (words >> kind >> index && std::getline(words >> std::ws, outcome)) known_[{kind, index}] = outcome;
  }
  in.close();
  out_.open(path, std::ios::app);
  if (!continues) out_ << settings << '\n';
}

const std::string* DriveRecord::known(const std::string& kind, int index) const {
  const auto found = known_.find({kind, index});
  return found == known_.end() ? nullptr : &found->second;
}

void DriveRecord::add(const std::string& kind, int index, const std::string& outcome) {
  if (out_.is_open()) out_ << kind << ' ' << index << ' ' << outcome << std::endl;
}

testing::Random random_of_drive(std::uint64_t seed, std::size_t kind, int index) {
  testing::Random of_kind(seed + 1000003 * kind);
  testing::Random one(of_kind.bits() + 0xd1b54a32d192ed03ULL * static_cast<std::uint64_t>(index));
  return testing::Random(one.bits());
}

}  // namespace egocal::bench
