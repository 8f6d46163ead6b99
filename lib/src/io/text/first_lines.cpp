// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/first_lines.hpp"

#include <algorithm>
#include <optional>

#include "egocal/error.hpp"
#include "io/text/line_reader.hpp"

namespace egocal::detail {

namespace {

constexpr std::size_t sniffed_bytes = 64 << 10;  // a limit: some hundred rows show the layout

enum class YamlLine { no, value, nested };

/// "key: value"; nested: "- key: value", or "key:" alone. After any blanks.
YamlLine yaml_line(std::string_view line) {
  while (line.ends_with('\r') || line.ends_with(' ')) line.remove_suffix(1);
  const std::size_t begin = std::min(line.find_first_not_of(" -"), line.size());
  const bool item = line.substr(0, begin).find('-') != std::string_view::npos;
  line.remove_prefix(begin);
  const auto of_key = [](char c) {
    return c == '_' || (c >= '0' && c <= '9') || (lower_case(c) >= 'a' && lower_case(c) <= 'z');
  };
  const auto key = std::find_if_not(line.begin(), line.end(), of_key);
  if (key == line.begin() || key == line.end() || *key != ':') return YamlLine::no;
  if (key + 1 == line.end()) return YamlLine::nested;
  return key[1] != ' ' ? YamlLine::no : item ? YamlLine::nested : YamlLine::value;
}

/// Whether a text is YAML: two lines with keys, one of them nested. Lines about a recording before its table
/// are not.
bool is_yaml(std::string_view text) {
  if (text.starts_with("%YAML") || text.starts_with("---\n")) return true;
  bool nested = false;
  for (int lines = 0; lines < 2;) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return false;
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (line.starts_with('#')) continue;
    const YamlLine kind = yaml_line(line);
    if (kind == YamlLine::no) return false;
    nested = nested || kind == YamlLine::nested;
    ++lines;
  }
  return nested;
}

/// Throws Error for JSON, XML, YAML, point clouds and pose graphs, which are text, but no tables.
void refuse_other_text(const std::string& file, std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  const std::string_view start = text.substr(begin, 16);
  const auto begins = [&](std::string_view word) { return start.substr(0, word.size()) == word; };
  const char* kind = begins("{") || begins("[")             ? "JSON"
                     : begins("<")                          ? "XML"
                     : is_yaml(text.substr(begin))          ? "YAML"
                     : begins("ply") || begins("# .PCD")    ? "a point cloud"
                     : begins("VERTEX_") || begins("EDGE_") ? "a pose graph (g2o)"
                                                            : nullptr;
  if (kind)
    throw error_at(file, 0, "",
                   std::string("is ") + kind +
                       ", not a trajectory; write a table of its poses, one a line: t,x,y,z,qx,qy,qz,qw");
}

/// What people have beside recordings, by its first bytes.
struct BinaryKind {
  std::string_view begin;
  const char* words;
};
constexpr std::string_view lcm_log_begin = "\xed\xa1\xda\x01";
constexpr BinaryKind binary_kinds[] = {
    {"PK\x03\x04", "is a zip archive: unpack it (an .npz of numpy: numpy.savetxt)"},
    {"\x93NUMPY", "is an array of numpy: write it as text by numpy.savetxt"},
    {"\x89HDF", "is an HDF5 file: write a table of its poses, one a line: t,x,y,z,qx,qy,qz,qw"},
    {"PAR1", "is a Parquet file: write it as csv"},
    {"ARROW1", "is a Feather file: write it as csv"},
    {lcm_log_begin,
     "is an LCM log: the commands of egocal read it, the library does not (egocal log export writes it as "
     "MCAP)"},
    {"ULog", "is a log of PX4: ulog2csv writes its topics as csv"},
    {"7z\xbc\xaf", "is a 7z archive: unpack it"},
    {"\xff\xfe", "is text of two bytes a character (UTF-16): save it as UTF-8"},
    {"\xfe\xff", "is text of two bytes a character (UTF-16): save it as UTF-8"}};

[[noreturn]] void refuse_binary(const ByteSource& source, std::string_view bytes) {
  const std::string& file = source.file();
  const std::optional<Packing>& packing = source.packing();
  if (packing && bytes.starts_with(lcm_log_begin))
    throw error_at(file, 0, "", packed_log_refused(*packing, file));
  if (packing && packing_of(bytes))  // by xz, or twice
    throw error_at(file, 0, "",
                   "is packed by " + std::string(packing->name) +
                       ", unpack it first: " + unpacking_command(*packing, file));
  for (const BinaryKind& kind : binary_kinds)
    if (bytes.substr(0, kind.begin.size()) == kind.begin) throw error_at(file, 0, "", kind.words);
  throw error_at(file, 0, "",
                 "is neither text nor a known recording; expected TUM, KITTI, EuRoC csv, a table with named "
                 "columns, MCAP, a ROS 1 bag or a rosbag2 database");
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r") == std::string_view::npos;
}

/// Whether there are only numbers between blanks or tabs, some with a decimal comma.
bool has_commas_in_numbers(std::string_view line) {
  std::vector<std::string_view> fields;
  split(line, ' ', fields);
  return fields.size() >= 3 && std::all_of(fields.begin(), fields.end(), [](std::string_view field) {
           return is_number(field) || has_decimal_comma(field);
         });
}

std::size_t count_of(std::string_view text, char c) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), c));
}

/// Whether a line has names between tabs, none of them empty.
bool names_between_tabs(std::string_view line) {
  std::vector<std::string_view> names;
  const std::size_t all = split(line, '\t', names);
  const auto odd = [](std::string_view name) {
    return name.empty() || name.back() == ',' || name.back() == ';';  // which come before the tabs
  };
  return all >= 3 && names.size() + 1 >= all && std::none_of(names.begin(), names.end(), odd);
}

/// Whether each tab ends a field, so that fields may be empty. Only names tell it: those of a header, of a
/// comment or of the option. Other files are fields between any number of blanks and tabs.
bool tabs_delimit(const Sniffed& sniffed, const std::string& columns) {
  const std::string& first = sniffed.data.front().text;
  const bool header = is_header(first, '\t');
  std::size_t tabs = count_of(first, '\t');
  bool named = header && names_between_tabs(first);
  if (!header && !columns.empty()) {
    named = tabs == count_of(columns, ',');
  } else if (!header) {
    for (const Line& comment : sniffed.comments)
      named = named || (names_between_tabs(comment.text) && count_of(comment.text, '\t') == tabs);
  }
  if (!named || tabs < 2) return false;
  const auto rows = static_cast<std::ptrdiff_t>(sniffed.data.size()) - (header ? 1 : 0);
  const auto alike =
      std::count_if(sniffed.data.begin() + (header ? 1 : 0), sniffed.data.end(), [&](const Line& line) {
        std::vector<std::string_view> fields;
        split(line.text, '\t', fields);
        return count_of(line.text, '\t') == tabs &&
               std::none_of(fields.begin(), fields.end(), [](std::string_view field) {
                 return field.ends_with(',') || field.ends_with(';');
               });
      });
  return 2 * alike > rows;
}

}  // namespace

char separator_of(const Sniffed& sniffed, const std::string& columns) {
  if (tabs_delimit(sniffed, columns)) return '\t';
  const std::string& line = sniffed.data.back().text;
  if (line.find(';') != std::string_view::npos) return ';';
  return line.find(',') != std::string_view::npos && !has_commas_in_numbers(line) ? ',' : ' ';
}

Sniffed sniff(ByteSource& source) {
  const std::string_view line_ends = line_ends_of(source);
  const ByteSpan bytes = source.peek(sniffed_bytes);
  const bool all = bytes.size() < sniffed_bytes;
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.find('\0') != std::string_view::npos) refuse_binary(source, text);
  if (text.rfind("version https://git-lfs", 0) == 0)
    throw error_at(source.file(), 0, "", "is a pointer of git-lfs, not the file itself: run `git lfs pull`");
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  refuse_other_text(source.file(), text);
  Sniffed sniffed;
  long number = 0;
  while (!text.empty()) {
    const LineSize size = first_line(text, line_ends);
    if (!size.terminated && !all && !sniffed.data.empty()) break;  // a part of a line
    const std::string_view line = text.substr(0, size.size);
    text.remove_prefix(size.whole);
    ++number;
    if (is_blank(line)) continue;
    const char first = line[line.find_first_not_of(" \t")];
    if (first == '#' || first == '%') {
      if (sniffed.data.empty()) sniffed.comments.push_back({number, std::string(line)});
    } else {
      // a header may name a column "#"; a row begins with a number
      const bool row = first == '-' || first == '+' || first == '.' || (first >= '0' && first <= '9');
      sniffed.data.push_back({number, std::string(row ? without_comment(line) : line)});
    }
  }
  return sniffed;
}

bool is_number(std::string_view text) {
  double value = 0;
  return parse_number(text, value);
}

bool is_header(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  split(line, separator, fields);
  const auto words = std::count_if(fields.begin(), fields.end(), [](std::string_view field) {
    return !is_number(field) && !has_decimal_comma(field);
  });
  return fields.size() >= 3 && !is_number(fields[0]) &&
         2 * words > static_cast<std::ptrdiff_t>(fields.size());
}

bool has_decimal_commas(const Sniffed& sniffed, char separator) {
  bool any = false;
  std::vector<std::string_view> fields;
  for (const Line& line : sniffed.data) {
    split(line.text, separator, fields);
    for (const std::string_view field : fields) {
      any = any || has_decimal_comma(field);
      if (field.find('.') != std::string_view::npos && is_number(field)) return false;
    }
  }
  return any;
}

const Line& first_whole_row(const Sniffed& sniffed, char separator) {
  std::vector<std::string_view> fields;
  for (const Line& line : sniffed.data) {
    split(line.text, separator, fields);
    if (std::none_of(fields.begin(), fields.end(), is_missing_number)) return line;
  }
  return sniffed.data.front();
}

}  // namespace egocal::detail
