// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/line_reader.hpp"

#include "egocal/error.hpp"

namespace egocal::detail {

namespace {

std::string_view text_of(ByteSpan bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::string_view line_ends_of(ByteSource& source) {
  constexpr std::size_t most = 1 << 16;  // bytes: a line of text is shorter
  const std::string_view text = text_of(source.peek(most));
  std::size_t lf = 0, cr = 0;  // a CR before an LF is none
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') ++lf;
    if (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n')) ++cr;
  }
  if (cr <= lf) return "\n";
  return lf == 0 ? "\r" : "\r\n";
}

LineSize first_line(std::string_view text, std::string_view line_ends) {
  const std::size_t end =
      line_ends.size() == 1 ? text.find(line_ends.front()) : text.find_first_of(line_ends);
  if (end == text.npos) return {text.size(), text.size(), false};
  const bool two = line_ends.size() > 1 && text.substr(end, 2) == "\r\n";
  return {end, end + (two ? 2 : 1), true};
}

bool LineReader::next(std::string_view& line) {
  constexpr std::size_t longest = 1 << 20;  // [bytes]
  source_.skip(pending_);
  pending_ = 0;
  if (number_ == 0) line_ends_ = line_ends_of(source_);
  std::string_view text;
  LineSize size;
  for (std::size_t look = 1 << 10; !size.terminated; look *= 8) {
    text = text_of(source_.peek(look));
    if (text.empty()) return false;
    size = first_line(text, line_ends_);
    if (text.size() < look) break;
    if (!size.terminated && look >= longest)
      throw error_at(source_.file(), number_ + 1, "", "expected a text file, got a line above 1 MiB");
  }
  terminated_ = size.terminated;
  pending_ = size.whole;
  line = text.substr(0, size.size);
  if (++number_ == 1 && line.substr(0, 3) == "\xef\xbb\xbf") line.remove_prefix(3);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

}  // namespace egocal::detail
