// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What drawing and keys both need of a view.
#pragma once

#include <algorithm>
#include <cstddef>

#include "egocal/monitor/view.hpp"

namespace egocal::monitor {

/// The pair that the view shows; null: there is none.
inline const PairState* selected_pair(const Model& model, const ViewState& view) {
  if (model.pairs().empty()) return nullptr;
  const int last = static_cast<int>(model.pairs().size()) - 1;
  return &model.pairs()[static_cast<std::size_t>(std::clamp(view.selected, 0, last))];
}

/// Rows of a list of this height; the title takes one row if there is room.
inline int event_rows(int height) {
  return height < 3 ? std::max(1, height) : height - 1;
}

}  // namespace egocal::monitor
