// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "egocal/bus/transport.hpp"

namespace egocal::bus {

/// LCM's UDP multicast. Throws Error if the kernel gives no sockets. A missing network is awaited.
std::unique_ptr<Transport> open_udp_transport(const LcmUrl& url, const Clock& clock);

}  // namespace egocal::bus
