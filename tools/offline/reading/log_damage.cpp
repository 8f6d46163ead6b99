// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/log_damage.hpp"

#include <algorithm>
#include <cstdint>

#include "egocal/in_words.hpp"

namespace egocal::tools {

std::string damage_in_words(const bus::LogDamage& damage) {
  if (!damage.any()) return {};
  std::string text = "the log is damaged: ";
  if (damage.bytes > 0)
    text += counted(damage.bytes, "byte") + " in " +
            counted(std::max<std::uint64_t>(damage.regions, 1), "region") + " and ";
  const std::uint64_t events = std::max<std::uint64_t>({damage.lost_events, damage.regions, 1});
  text += "at least " + counted(events, "event") + (events == 1 && damage.bytes == 0 ? " is" : " are") +
          " lost and in no answer";
  if (damage.jumps > 0) text += ", the numbers of its events jump at " + counted(damage.jumps, "place");
  if (damage.truncated) text += ", and its end is cut off";
  return text + "; see egocal log check";
}

}  // namespace egocal::tools
