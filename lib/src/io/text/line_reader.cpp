// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/line_reader.hpp"

#include <cstring>

#include "egocal/error.hpp"

namespace egocal::detail {

char line_end_of(ByteSource& source) {
  constexpr std::size_t most = 1 << 16;  // bytes: a line of text is shorter
  const ByteSpan bytes = source.peek(most);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.find('\n') == text.npos && text.find('\r') != text.npos ? '\r' : '\n';
}

bool LineReader::next(std::string_view& line) {
  constexpr std::size_t longest = 1 << 20;  // [bytes]
  source_.skip(pending_);
  pending_ = 0;
  if (number_ == 0) line_end_ = line_end_of(source_);
  ByteSpan bytes;
  const void* end = nullptr;
  for (std::size_t look = 1 << 10; !end; look *= 8) {
    bytes = source_.peek(look);
    if (bytes.empty()) return false;
    end = std::memchr(bytes.data(), line_end_, bytes.size());
    if (bytes.size() < look) break;
    if (!end && look >= longest)
      throw error_at(source_.file(), number_ + 1, "", "expected a text file, got a line above 1 MiB");
  }
  terminated_ = end != nullptr;
  const char* const begin = reinterpret_cast<const char*>(bytes.data());
  std::size_t size =
      terminated_ ? static_cast<std::size_t>(static_cast<const char*>(end) - begin) : bytes.size();
  pending_ = size + (terminated_ ? 1 : 0);
  line = {begin, size};
  if (++number_ == 1 && line.substr(0, 3) == "\xef\xbb\xbf") line.remove_prefix(3);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

}  // namespace egocal::detail
