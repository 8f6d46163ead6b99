// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "markdown_tables.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "egocal/io/whole_file.hpp"

namespace egocal::bench {

namespace {

struct Place {
  std::size_t begin, end;
};

Place place_of(const std::string& page, const std::string& name) {
  const std::string first = "<!-- begin " + name + " -->\n", last = "<!-- end " + name + " -->";
  const std::size_t begin = page.find(first), end = page.find(last);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw std::runtime_error("the page has no place for the table '" + name + "'");
  return {begin + first.size(), end};
}

/// A text in words and numbers alternately: "0.231 deg" is "", 0.231, " deg".
struct Parts {
  std::vector<std::string> words;
  std::vector<std::string> numbers;
};

Parts parts_of(const std::string& text) {
  Parts parts;
  std::string word, number;
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool starts =
        is_digit(text[i]) && (i == 0 || std::isalnum(static_cast<unsigned char>(text[i - 1])) == 0);
    if (!starts) {
      word += text[i];
      continue;
    }
    while (i < text.size() && (is_digit(text[i]) || text[i] == '.')) number += text[i++];
    --i;
    parts.words.push_back(std::move(word));
    parts.numbers.push_back(std::move(number));
    word.clear();
    number.clear();
  }
  parts.words.push_back(std::move(word));
  return parts;
}

double last_place(const std::string& number) {
  const std::size_t point = number.find('.');
  return point == std::string::npos ? 1 : std::pow(10.0, -static_cast<double>(number.size() - point - 1));
}

bool alike(const std::string& x, const std::string& y, double relative) {
  const Parts a = parts_of(x), b = parts_of(y);
  if (a.words != b.words) return false;
  for (std::size_t i = 0; i < a.numbers.size(); ++i) {
    const double u = std::stod(a.numbers[i]), v = std::stod(b.numbers[i]);
    const double allowed = std::max(relative * std::max(u, v), 1.01 * last_place(a.numbers[i]));
    if (std::abs(u - v) > allowed) return false;
  }
  return true;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

std::string part(int x, int of) {
  return std::to_string(x) + " of " + std::to_string(of);
}

std::string markdown(const Table& table) {
  std::string text;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    text += "|";
    for (const std::string& cell : table.rows[row]) text += " " + cell + " |";
    text += "\n";
    if (row > 0) continue;
    text += "|";
    for (std::size_t i = 0; i < table.rows[row].size(); ++i) text += " --- |";
    text += "\n";
  }
  return text;
}

std::string read_page(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream all;
  all << stream.rdbuf();
  return all.str();
}

std::string with_table(const std::string& page, const Table& table) {
  const Place place = place_of(page, table.name);
  return page.substr(0, place.begin) + markdown(table) + page.substr(place.end);
}

std::vector<std::string> differences(const std::string& page, const Table& table, double relative) {
  const Place place = place_of(page, table.name);
  const std::vector<std::string> written = lines_of(page.substr(place.begin, place.end - place.begin));
  const std::vector<std::string> made = lines_of(markdown(table));
  std::vector<std::string> found;
  for (std::size_t i = 0; i < std::max(written.size(), made.size()); ++i) {
    const std::string x = i < written.size() ? written[i] : "", y = i < made.size() ? made[i] : "";
    if (!alike(x, y, relative)) found.push_back("page: " + x + "\n now: " + y);
  }
  return found;
}

std::string with_rows_of(const std::string& page, const Table& table) {
  const Place place = place_of(page, table.name);
  std::string kept;
  std::size_t number = 0;
  for (const std::string& line : lines_of(page.substr(place.begin, place.end - place.begin))) {
    const bool heading = number++ < 2;
    const bool made = std::any_of(table.rows.begin(), table.rows.end(), [&line](const auto& row) {
      return line.rfind("| " + row.front() + " |", 0) == 0;
    });
    if (heading || made) kept += line + "\n";
  }
  return page.substr(0, place.begin) + kept + page.substr(place.end);
}

int publish(const Table& table, const std::string& write, const std::string& check) {
  std::printf("%s\n", markdown(table).c_str());
  if (table.rows.size() < 2) {
    std::printf("%s: no row was asked for\n", table.name.c_str());
    return 2;
  }
  if (!write.empty()) write_whole_file(write, with_table(read_page(write), table));
  if (check.empty()) return 0;
  const std::vector<std::string> found = differences(with_rows_of(read_page(check), table), table, 0.03);
  for (const std::string& difference : found) std::printf("%s\n", difference.c_str());
  return found.empty() ? 0 : 1;
}

}  // namespace egocal::bench
