// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/silence.hpp"

#include <algorithm>
#include <utility>

namespace egocal::tools {

Silence::Next Silence::look(std::chrono::milliseconds since, std::chrono::milliseconds passed,
                            bool another_is_heard, const SilenceOptions& options) {
  silent_ = std::min(since, another_is_heard ? silent_ + passed : silent_);
  if (silent_ < options.silent) return std::exchange(reported_, false) ? Next::report_heard : Next::nothing;
  if (!reported_) {
    reported_ = true;
    return Next::report_and_continue;
  }
  if (silent_ <= options.hangs) return Next::nothing;
  *this = {};
  return Next::kill;
}

}  // namespace egocal::tools
