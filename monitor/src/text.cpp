// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/monitor/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace egocal::monitor {
namespace {

constexpr Symbols ascii_glyphs{"->", "+-", "deg", "u", "+", "!", "*", "x", ">", "|", "-", "#", ".", "inf"};
constexpr Symbols unicode_glyphs{"→", "±", "°", "µ", "✓", "✗", "●", "○", "▸", "·", "─", "█", "░", "∞"};

// Whether every terminal draws the character one cell wide. Others could tear the screen.
bool is_safe(char32_t c) {
  if (c < 0x20) return false;
  if (c < 0x7f) return true;
  if (c == 0xad) return false;
  return (c >= 0xa1 && c <= 0x2ff) || (c >= 0x370 && c <= 0x482) || (c >= 0x48a && c <= 0x52f) || c == 0x2192;
}

std::string printed(const char* format, int decimals, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, decimals, value);
  return buffer;
}

}  // namespace

const Symbols& symbols(Charset charset) {
  return charset == Charset::unicode ? unicode_glyphs : ascii_glyphs;
}

std::u32string decode(std::string_view text) {
  std::u32string glyphs;
  glyphs.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80         ? 1
                               : (lead >> 5) == 6  ? 2
                               : (lead >> 4) == 14 ? 3
                               : (lead >> 3) == 30 ? 4
                                                   : 0;
    char32_t glyph = length == 1   ? lead
                     : length == 2 ? lead & 0x1fu
                     : length == 3 ? lead & 0x0fu
                                   : lead & 0x07u;
    bool valid = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; valid && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      valid = (next >> 6) == 2;
      glyph = (glyph << 6) | (next & 0x3fu);
    }
    // an overlong form could hide a control character from the check
    valid = valid && !(length == 2 && glyph < 0x80) && !(length == 3 && glyph < 0x800) &&
            !(length == 4 && (glyph < 0x10000 || glyph > 0x10ffff));
    glyphs += valid ? glyph : U'?';
    i += valid ? length : 1;
  }
  return glyphs;
}

void append_utf8(std::string& text, char32_t c) {
  const auto byte = [&](char32_t b) { text += static_cast<char>(static_cast<unsigned char>(b)); };
  if (c < 0x80) {
    byte(c);
  } else if (c < 0x800) {
    byte(0xc0 | (c >> 6));
    byte(0x80 | (c & 0x3f));
  } else if (c < 0x10000) {
    byte(0xe0 | (c >> 12));
    byte(0x80 | ((c >> 6) & 0x3f));
    byte(0x80 | (c & 0x3f));
  } else {
    byte(0xf0 | (c >> 18));
    byte(0x80 | ((c >> 12) & 0x3f));
    byte(0x80 | ((c >> 6) & 0x3f));
    byte(0x80 | (c & 0x3f));
  }
}

namespace {
constexpr std::size_t longest_name = 1000;  // a limit [characters]: several lines of any terminal
}

std::string clean(std::string_view text, std::size_t max) {
  std::string result;
  std::size_t cells = 0;
  // a character has at most four bytes, so later bytes cannot be shown and are not decoded
  const std::u32string glyphs = decode(text.substr(0, 4 * max + 4));
  for (char32_t glyph : glyphs) {
    if (++cells > max) break;
    if (cells == max && glyphs.size() > max) {
      result += '~';
      break;
    }
    append_utf8(result, is_safe(glyph) ? glyph : U'?');
  }
  return result;
}

std::string clean_name(std::string_view name, std::size_t max) {
  const std::string whole = clean(name, longest_name);
  const std::u32string glyphs = decode(whole);
  if (glyphs.size() <= max || max < 3) return clean(whole, max);
  const std::size_t head = (max - 1) / 2, tail = max - 1 - head;
  std::string result;
  for (const char32_t glyph : glyphs.substr(0, head)) append_utf8(result, glyph);
  result += '~';
  for (const char32_t glyph : glyphs.substr(glyphs.size() - tail)) append_utf8(result, glyph);
  return result;
}

std::vector<std::string> wrapped(std::string_view text, std::size_t max, std::size_t indent) {
  std::u32string rest = decode(clean(text, longest_name));
  const std::u32string begin(max > 2 * indent ? indent : 0, U' ');
  std::vector<std::string> lines;
  while (max > 0 && !rest.empty()) {
    std::size_t end = std::min(rest.size(), max);
    if (end < rest.size()) {
      const std::size_t blank = rest.rfind(U' ', end);
      if (blank != rest.npos && 2 * blank > end) end = blank;
    }
    std::string& line = lines.emplace_back();
    for (const char32_t glyph : rest.substr(0, end)) append_utf8(line, glyph);
    rest.erase(0, end);
    if (!rest.empty() && rest.front() == U' ') rest.erase(0, 1);
    if (!rest.empty()) rest = begin + rest;
  }
  return lines;
}

std::string without_folders(std::string_view text, std::size_t max) {
  std::string result(text);
  for (std::size_t begin = 0; begin < result.size() && width_of(result) > static_cast<int>(max);) {
    const std::size_t end = std::min(result.find_first_of(" :", begin), result.size());
    const std::size_t folder = end > begin ? result.rfind('/', end - 1) : std::string::npos;
    if (folder == std::string::npos || folder <= begin + 1) {
      begin = end + 1;
      continue;
    }
    result.replace(begin, folder - begin, "~");
    begin += end - folder + 2;
  }
  return result;
}

int width_of(std::string_view text) {
  int width = 0;
  for (char c : text) width += (static_cast<unsigned char>(c) >> 6) != 2;
  return width;
}

namespace {
std::string cut(std::string_view text, int width) {
  std::string result;
  int cells = 0;
  for (char c : text) {
    if ((static_cast<unsigned char>(c) >> 6) != 2 && ++cells > width) break;
    result += c;
  }
  return result;
}
}  // namespace

std::string pad_right(std::string_view text, int width) {
  if (width <= 0) return "";
  std::string result = cut(text, width);
  result.append(static_cast<std::size_t>(width - width_of(result)), ' ');
  return result;
}

std::string pad_left(std::string_view text, int width) {
  if (width <= 0) return "";
  const std::string result = cut(text, width);
  return std::string(static_cast<std::size_t>(width - width_of(result)), ' ') + result;
}

std::string number(double value, int decimals, Charset charset) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return std::string(value < 0 ? "-" : "") + symbols(charset).infinite;
  if (std::abs(value) >= 1e5) return printed("%.*e", 1, value);
  std::string text = printed("%.*f", decimals, value);
  if (text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string compact(double value, Charset charset) {
  if (!std::isfinite(value)) return number(value, 0, charset);
  const double magnitude = std::abs(value);
  if (magnitude == 0) return "0";
  if (magnitude >= 1e5 || magnitude < 1e-3) return printed("%.*e", 1, value);
  return printed("%.*f",
                 magnitude >= 100   ? 0
                 : magnitude >= 10  ? 1
                 : magnitude >= 1   ? 2
                 : magnitude >= 0.1 ? 3
                                    : 4,
                 value);
}

std::string duration(double seconds, Charset charset) {
  if (!(seconds >= 0)) return "-";
  if (seconds >= 1e6) return "long";
  const char* micro = symbols(charset).micro;
  const auto with = [](double value, const std::string& unit) {
    return printed("%.*f", value < 9.95 ? 1 : 0, value) + " " + unit;
  };
  if (seconds < 9.995e-4) return with(seconds * 1e6, std::string(micro) + "s");
  if (seconds < 0.9995) return with(seconds * 1e3, "ms");
  return with(seconds, "s");
}

std::string age(double seconds) {
  if (!(seconds >= 0) || std::isinf(seconds)) return "-";
  if (seconds < 1) return "now";
  if (seconds < 100) return printed("%.*f s", 0, seconds);
  if (seconds < 6000) return printed("%.*f min", 0, seconds / 60);
  if (seconds < 360000) return printed("%.*f h", 0, seconds / 3600);
  return "days";
}

std::string count(std::int64_t value) {
  const double magnitude = std::abs(static_cast<double>(value));
  if (magnitude < 1e5) return std::to_string(value);
  if (magnitude < 1e6) return printed("%.*fk", 0, static_cast<double>(value) / 1e3);
  if (magnitude < 1e9) return printed("%.*fM", 1, static_cast<double>(value) / 1e6);
  return printed("%.*e", 1, static_cast<double>(value));
}

std::string clock_time(std::int64_t wall_us, int utc_offset_s) {
  const std::int64_t day = 86400;
  std::int64_t s = (wall_us / 1000000 % day + utc_offset_s) % day;
  if (s < 0) s += day;
  char buffer[16];
  std::snprintf(buffer, sizeof buffer, "%02d:%02d:%02d", static_cast<int>(s / 3600),
                static_cast<int>(s / 60 % 60), static_cast<int>(s % 60));
  return buffer;
}

std::optional<Size> size_from_text(const std::string& text) {
  constexpr int most = 1000;  // cells; no terminal has more
  const auto number = [](const char* begin, const char* end) {
    int value = 0;
    const auto [rest, error] = std::from_chars(begin, end, value);
    return error == std::errc() && rest == end && value >= 1 && value <= most ? value : 0;
  };
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos) return std::nullopt;
  const char* const middle = text.data() + cross;
  const Size size{number(text.data(), middle), number(middle + 1, text.data() + text.size())};
  return size.width > 0 && size.height > 0 ? std::optional(size) : std::nullopt;
}

}  // namespace egocal::monitor
