// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Values of messages whose senders may be anybody.
#pragma once

#include <cstdint>
#include <string>

#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

/// From one time to another [s]; no overflow, whatever the times are.
inline double seconds(std::int64_t from_us, std::int64_t to_us) {
  return (static_cast<double>(to_us) - static_cast<double>(from_us)) * 1e-6;
}

/// What is kept of a text.
inline std::string bounded(const std::string& text) {
  return text.substr(0, Model::max_text);
}

}  // namespace egocal::monitor
