// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/whole_file.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "egocal/error.hpp"

namespace egocal {

void write_whole_file(const std::string& file, std::string_view content) {
  // a device or a pipe (/dev/stdout) is written to, never replaced
  std::error_code none;
  const std::filesystem::file_status there = std::filesystem::status(file, none);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) {
    std::ofstream stream(file, std::ios::binary);
    stream << content;
    stream.close();
    if (!stream) throw error_at(file, 0, "", "cannot be written");
    return;
  }
  const std::string temporary = file + ".part";
  {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    stream << content;
    stream.close();
    if (!stream) {
      std::remove(temporary.c_str());
      throw error_at(file, 0, "", "cannot be written");
    }
  }
  if (std::rename(temporary.c_str(), file.c_str()) != 0) {
    std::remove(temporary.c_str());
    throw error_at(file, 0, "", "cannot be written");
  }
}

}  // namespace egocal
