// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/channel_list.hpp"

#include "egocal/bus/convert.hpp"

namespace egocal::tools {

namespace {
constexpr std::size_t most_shown = 10, most_known = 1000;  // limits of a message, and on memory
}

void ChannelList::add(const std::string& name) {
  if (names_.size() < most_known) names_.insert(name);
}

std::string ChannelList::text() const {
  if (names_.empty()) return "none";
  std::string text;
  std::size_t count = 0;
  for (const std::string& name : names_) {
    if (count == most_shown) break;
    text += (count++ ? ", " : "") + bus::printable(name, 63);
  }
  if (names_.size() == count) return text;
  return text + (names_.size() >= most_known ? " and more than " : " and ") +
         std::to_string(names_.size() - count) + " others";
}

}  // namespace egocal::tools
