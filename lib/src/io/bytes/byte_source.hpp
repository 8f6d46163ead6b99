// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "egocal/io/descriptor.hpp"
#include "egocal/io/packing.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "io/bytes/unpacker.hpp"

namespace egocal::detail {

using ByteSpan = std::span<const unsigned char>;

/// The bytes of a file from its beginning to its end, unpacked on the way where it is gzip, zstd, bzip2 or
/// lz4 (recognised by its first bytes). Memory: a window of 256 KiB (of a smaller file: its
/// size), or as much as peek() asks for. Throws Error where the file cannot be opened or read.
class ByteSource {
 public:
  explicit ByteSource(const std::string& file);
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  const std::string& file() const { return file_; }
  /// How the file is packed, also where it is not unpacked on the way (xz). Empty: a plain file.
  const std::optional<Packing>& packing() const { return packing_; }

  /// The next `size` bytes, fewer only at the end. Valid until the next call of peek() or skip().
  ByteSpan peek(std::size_t size);
  /// Passes over `size` bytes; returns how many there were.
  std::uint64_t skip(std::uint64_t size);
  /// Offset of the next byte, after unpacking.
  std::uint64_t offset() const { return window_offset_ + position_; }
  /// Bytes of the whole file where that is known: a plain file on a disk; otherwise 0.
  std::uint64_t plain_size() const { return unpacker_ ? 0 : size_; }
  /// Counts, at the end, what a packed file that is damaged or cut off has lost; once until rewind().
  void count_unpacking(ReadLosses& losses);
  /// "holds no data", and why where unpacking has failed: for a file in which nothing was found.
  std::string why_empty() const;
  /// Reads `content`. Where that throws and what is packed is damaged, rubbish may have been unpacked: the
  /// Error then names the damage first.
  void read_content(const std::function<void()>& content);

  /// Goes back to the first byte. Throws Error where the file is a pipe that has been read from.
  void rewind();

 private:
  void fill(std::size_t size);
  std::size_t read_raw(unsigned char* to, std::size_t size);
  std::size_t read_unpacked(unsigned char* to, std::size_t size);
  std::uint64_t packed_left() const;
  bool fails_to_unpack();
  const char* what_failed() const;

  std::string file_;
  Descriptor descriptor_;
  bool seekable_ = false;
  std::uint64_t size_ = 0;
  std::optional<Packing> packing_;
  std::unique_ptr<Unpacker> unpacker_;
  std::vector<unsigned char> packed_;           ///< input of the unpacker
  std::size_t packed_at_ = 0, packed_end_ = 0;  ///< what of it is still to be unpacked
  enum class Failure { none, cut_off, damaged, checksum } failure_ = Failure::none;  ///< of unpacking
  bool end_ = false, counted_ = false;
  std::vector<unsigned char> window_;
  std::size_t position_ = 0, filled_ = 0;  ///< in the window
  std::uint64_t window_offset_ = 0;        ///< of the window's first byte
};

}  // namespace egocal::detail
