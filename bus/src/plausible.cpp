// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/plausible.hpp"

#include <algorithm>

namespace egocal::bus {

namespace {

constexpr std::size_t max_name = 40, max_text = 1000;  // limits of the wire [bytes]

}  // namespace

bool plausible_name(const std::string& name) {
  return !name.empty() && name.size() <= max_name &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                  c == '-';
         });
}

bool plausible_text(const std::string& text) {
  return text.size() <= max_text;
}

}  // namespace egocal::bus
