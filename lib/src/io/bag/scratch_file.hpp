// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/bytes/byte_source.hpp"

namespace egocal::detail {

/// All bytes of a source in a temporary file, for readers that need random access. The destructor removes it.
/// It takes at most nine tenths of the free space. Throws Error naming the source if that is too little.
class ScratchFile {
 public:
  explicit ScratchFile(ByteSource& source);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::string& path() const { return path_; }
  const ReadLosses& losses() const { return losses_; }  ///< of unpacking the source

 private:
  void copy(ByteSource& source, int descriptor);
  std::string path_;
  ReadLosses losses_;
};

}  // namespace egocal::detail
