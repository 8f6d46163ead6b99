// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/trajectory_file.hpp"

namespace egocal {

std::string losses_in_words(const ReadLosses& losses) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (losses.parts > 0)
    add(std::to_string(losses.parts) + (losses.parts == 1 ? " part" : " parts") +
        " of the bag cannot be read (" + (losses.parts == 1 ? "" : "first: ") + losses.first_part + ")");
  if (losses.regions > 0)
    add(std::to_string(losses.regions) + " damaged " + (losses.regions == 1 ? "region (" : "regions (") +
        std::to_string(losses.bytes) + " bytes) skipped");
  if (losses.truncated) add("the end is cut off");
  if (losses.checksum)
    add("the checksum of the data differs: they were damaged since they were written (copy the file again)");
  if (losses.refused > 0)
    add(std::to_string(losses.refused) + " without a usable pose skipped (first: " + losses.first_refused +
        ")");
  return text;
}

}  // namespace egocal
