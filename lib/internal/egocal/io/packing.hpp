// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace egocal {

/// What a whole file is packed by.
struct Packing {
  std::string_view name, command;  ///< "gzip", and the program with its options that unpacks a file
};

/// How a file is packed, by its first bytes, six or more; empty where it is not packed.
std::optional<Packing> packing_of(std::string_view first_bytes);

/// What a shell unpacks the file by: "gunzip -k 'drive.log.gz'".
std::string unpacking_command(const Packing& packing, const std::string& file);

/// Why a packed LCM log is refused, in words for people. A log is read at any place of it: it is played from
/// there, and reading goes on behind damage. So it is not unpacked on the way, as tables and bags are.
std::string packed_log_refused(const Packing& packing, const std::string& file);

}  // namespace egocal
