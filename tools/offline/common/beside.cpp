// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/common/beside.hpp"

#include "egocal/bus/work_thread.hpp"

namespace egocal::tools {

void at_the_same_time(const std::function<void()>& first, const std::function<void()>& second) {
  bus::WorkThread other(second);
  first();
  other.finish();
}

void one_after_the_other(const std::function<void()>& first, const std::function<void()>& second) {
  first();
  second();
}

}  // namespace egocal::tools
