// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/error.hpp"

namespace egocal {

Error error_at(const std::string& file, long line, const std::string& field, const std::string& problem) {
  std::string text = file;
  if (line > 0) text += (text.empty() ? "line " : ":") + std::to_string(line);
  if (!text.empty()) text += ": ";
  if (!field.empty()) text += field + ": ";
  return Error(text + problem);
}

}  // namespace egocal
