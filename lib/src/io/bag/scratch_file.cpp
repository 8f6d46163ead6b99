// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/scratch_file.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"

namespace egocal::detail {

ScratchFile::ScratchFile(ByteSource& source) {
  std::error_code no_folder;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(no_folder);
  if (no_folder)
    throw error_at(
        source.file(), 0, "",
        "is a packed database, and TMPDIR is no folder that it can be unpacked to; set TMPDIR to one");
  path_ = (folder / "egocal_unpacked_XXXXXX").string();
  const int descriptor = ::mkostemp(path_.data(), O_CLOEXEC);
  if (descriptor < 0)
    throw error_at(source.file(), 0, "",
                   "is a packed database and cannot be unpacked to " + path_ + ": " + std::strerror(errno));
  try {
    copy(source, descriptor);
  } catch (...) {
    ::close(descriptor);
    ::unlink(path_.c_str());
    throw;
  }
  ::close(descriptor);
}

ScratchFile::~ScratchFile() {
  ::unlink(path_.c_str());
}

void ScratchFile::copy(ByteSource& source, int descriptor) {
  constexpr std::size_t step = 256 << 10;  // [bytes]
  std::error_code none;
  const std::filesystem::space_info space = std::filesystem::space(path_, none);
  const std::uintmax_t most = none ? UINTMAX_MAX : space.available / 10 * 9;
  const auto fail = [&](const std::string& why) {
    return error_at(source.file(), 0, "",
                    "is a packed database that does not fit unpacked into " +
                        std::filesystem::path(path_).parent_path().string() + " (" + why +
                        "); unpack it yourself, or set TMPDIR to a folder with more space");
  };
  std::uintmax_t written = 0;
  while (true) {
    const ByteSpan bytes = source.peek(step);
    if (bytes.empty()) break;
    const std::size_t size = bytes.size();
    written += size;
    if (written > most) throw fail("more than " + std::to_string(most) + " bytes");
    if (!write_all(descriptor, std::as_bytes(bytes))) throw fail(std::strerror(errno));
    source.skip(size);
  }
  source.count_unpacking(losses_);
}

}  // namespace egocal::detail
