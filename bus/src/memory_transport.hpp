// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "egocal/bus/transport.hpp"

namespace egocal::bus {

/// Transport of memq://: the sender receives its own messages, in order. For tests of handlers.
std::unique_ptr<Transport> open_memory_transport(const Clock& clock);

}  // namespace egocal::bus
