// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace egocal::detail {

/// Unpacks one stream of bytes piece by piece: gzip, zstd, lz4 frames or bz2.
class Unpacker {
 public:
  struct Step {
    std::size_t consumed = 0, produced = 0;  ///< [bytes]
    bool failed = false;                     ///< the packed bytes are damaged; nothing more can be unpacked
    bool checksum = false;                   ///< then: all of them were unpacked, and their checksum differs
  };
  virtual ~Unpacker() = default;
  virtual Step unpack(std::span<const unsigned char> from, std::span<unsigned char> to) = 0;
  virtual void restart() = 0;
  /// Whether a packed stream is at its end (several may follow each other), where a file may end.
  virtual bool complete() const = 0;
};

/// The unpacker for a whole file by its first bytes: gzip, zstd, bzip2 or lz4; empty for anything else.
std::unique_ptr<Unpacker> make_unpacker(std::span<const unsigned char> first_bytes);
/// The unpacker by the name that bags use: "zstd", "lz4", "bz2". Empty for an unknown name.
std::unique_ptr<Unpacker> make_unpacker(std::string_view name);

/// Unpacks all of `packed` to at most `most` bytes. False where it is damaged, cut off or longer than that;
/// `out` then holds what could be unpacked. Memory grows with what comes out, whatever a file claims.
bool unpack_all(Unpacker& unpacker, std::span<const unsigned char> packed, std::size_t most,
                std::vector<unsigned char>& out);

}  // namespace egocal::detail
