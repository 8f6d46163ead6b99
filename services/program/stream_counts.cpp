// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "program/stream_counts.hpp"

namespace egocal::services {

void add(const StreamCounts& counts, StreamCounts& sum) {
  sum.lost += counts.lost;
  sum.duplicate += counts.duplicate;
  sum.out_of_order += counts.out_of_order;
  sum.jump += counts.jump;
}

std::map<std::string, std::int64_t> named(const StreamCounts& counts) {
  return {{"lost", counts.lost},
          {"rejected: duplicate", counts.duplicate},
          {"rejected: too late", counts.out_of_order},
          {"rejected: time or number jumps", counts.jump}};
}

}  // namespace egocal::services
