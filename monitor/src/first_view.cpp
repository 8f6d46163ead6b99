// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "first_view.hpp"

#include <ctime>
#include <string>

namespace egocal::monitor {

namespace {

Screen screen_from(const std::string& name) {
  return name == "detail"    ? Screen::detail
         : name == "events"  ? Screen::events
         : name == "streams" ? Screen::streams
                             : Screen::overview;
}

}  // namespace

int utc_offset_s() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return static_cast<int>(local.tm_gmtoff);
}

ViewState first_view(const ProgramOptions& options, const Source& source) {
  ViewState view;
  view.screen = screen_from(options.screen);
  view.source = source.name();
  view.live = source.live();
  view.utc_offset_s = utc_offset_s();
  return view;
}

}  // namespace egocal::monitor
