// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/packing.hpp"

namespace egocal {

std::optional<Packing> packing_of(std::string_view first_bytes) {
  using namespace std::string_view_literals;
  struct Known {
    std::string_view begin;
    Packing packing;
  };
  // all keep the packed file
  constexpr Known all_known[] = {{"\x1f\x8b"sv, {"gzip", "gunzip -k"}},
                                 {"\x28\xb5\x2f\xfd"sv, {"zstd", "unzstd"}},
                                 {"BZh"sv, {"bzip2", "bunzip2 -k"}},
                                 {"\x04\x22\x4d\x18"sv, {"lz4", "unlz4"}},
                                 {"\xfd\x37zXZ\0"sv, {"xz", "unxz -k"}}};
  for (const Known& known : all_known)
    if (first_bytes.starts_with(known.begin)) return known.packing;
  return std::nullopt;
}

std::string unpacking_command(const Packing& packing, const std::string& file) {
  std::string quoted;
  for (const char c : file) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return std::string(packing.command) + " '" + quoted + "'";
}

std::string packed_log_refused(const Packing& packing, const std::string& file) {
  return "is packed by " + std::string(packing.name) +
         ", and a log is read unpacked: " + unpacking_command(packing, file);
}

}  // namespace egocal
