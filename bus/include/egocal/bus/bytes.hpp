// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace egocal::bus {

using Bytes = std::span<const std::byte>;

}  // namespace egocal::bus
