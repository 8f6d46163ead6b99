// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace egocal::bus {

/// Where the bus is: udpm://[GROUP][:PORT][?ttl=N&recv_buf_size=N], or memq:// (one process, for tests).
struct LcmUrl {
  bool memory = false;  ///< memq://
  std::string group = "239.255.76.67";
  std::uint16_t port = 7667;
  int ttl = 0;  ///< 0: nothing leaves the host
  /// [bytes] asked of the kernel, which gives up to net.core.rmem_max. Default: room for some 3000 poses; the
  /// kernel's own default holds some twenty problems.
  int receive_buffer = 4 * 1024 * 1024;
};

/// Throws Error with one line on anything else: LCM's other providers read and write files.
LcmUrl parse_lcm_url(const std::string& url);

}  // namespace egocal::bus
