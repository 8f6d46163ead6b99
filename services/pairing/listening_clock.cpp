// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/listening_clock.hpp"

#include <algorithm>

namespace egocal::services {

std::int64_t ListeningClock::now_us(std::int64_t mono_us) const {
  return listened_us_ + std::min(mono_us - looked_mono_us_, longest_us_);
}

bool ListeningClock::look(std::int64_t mono_us, bool read_all) {
  const std::int64_t listened = now_us(mono_us);
  const bool stopped = listened - listened_us_ < mono_us - looked_mono_us_;
  looked_mono_us_ = mono_us;
  catching_up_ = stopped || (catching_up_ && !read_all);
  if (!catching_up_) listened_us_ = listened;
  return stopped;
}

}  // namespace egocal::services
