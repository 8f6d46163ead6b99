// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/bag/bag_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>

namespace egocal::detail {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view packed_endings[] = {".zstd", ".zst", ".gz", ".bz2", ".lz4"};
constexpr const char* metadata_name = "metadata.yaml";

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Takes the digits at the start of a text, and returns them without leading zeros.
std::string_view take_number(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// Order of the parts of a bag by name: "drive_10.db3" after "drive_9.db3", and before "evening.db3".
bool natural_less(const std::string& a, const std::string& b) {
  std::string_view rest_a = a, rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    if (is_digit(rest_a[0]) && is_digit(rest_b[0])) {
      const std::string_view x = take_number(rest_a), y = take_number(rest_b);
      if (x != y) return x.size() != y.size() ? x.size() < y.size() : x < y;
      continue;
    }
    if (rest_a[0] != rest_b[0]) return rest_a[0] < rest_b[0];
    rest_a.remove_prefix(1);
    rest_b.remove_prefix(1);
  }
  if (rest_a.empty() != rest_b.empty()) return rest_a.empty();
  return a < b;  // 1 and 01
}

std::string without_packing(const std::string& name) {
  for (const std::string_view ending : packed_endings)
    if (name.ends_with(ending)) return name.substr(0, name.size() - ending.size());
  return name;
}

bool is_bag_name(const std::string& name) {
  const std::string plain = without_packing(name);
  return plain.ends_with(".mcap") || plain.ends_with(".db3");
}

/// One name of a YAML list, in quotes or not. The first versions of rosbag2 wrote the folder before it.
std::string list_item(std::string_view text) {
  constexpr std::string_view around = " \t\r\"'";
  const std::size_t begin = text.find_first_not_of(around);
  if (begin == std::string_view::npos) return {};
  text = text.substr(begin, text.find_last_not_of(around) - begin + 1);
  return std::string(text.substr(text.rfind('/') + 1));  // npos + 1 is 0
}

/// The list relative_file_paths, as a block or in brackets.
std::vector<std::string> named_files(const std::string& metadata) {
  std::vector<std::string> names;
  const auto take = [&](std::string_view text) {
    if (std::string name = list_item(text); !name.empty()) names.push_back(std::move(name));
  };
  std::ifstream stream(metadata, std::ios::binary);
  std::string line;
  bool inside = false;
  while (std::getline(stream, line)) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t\r"), line.size());
    const std::string_view text = std::string_view(line).substr(begin);
    if (inside && text.starts_with('-')) {
      take(text.substr(1));
      continue;
    }
    if (inside && !text.empty()) break;
    constexpr std::string_view key = "relative_file_paths:";
    if (!text.starts_with(key)) continue;
    inside = true;
    const std::size_t open = text.find('['), close = text.find(']');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) continue;
    std::istringstream list{std::string(text.substr(open + 1, close - open - 1))};
    for (std::string item; std::getline(list, item, ',');) take(item);
  }
  return names;
}

}  // namespace

BagFolder look_into(const std::string& folder) {
  std::set<std::string> there;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (const std::string name = entry->path().filename().string(); is_bag_name(name)) there.insert(name);
  // the unpacked one, which `unzstd` leaves beside the packed one; then the packed one of any program
  const auto path_of = [&](const std::string& name) -> std::string {
    const std::string plain = without_packing(name);
    if (there.contains(plain)) return (fs::path(folder) / plain).string();
    for (const std::string_view ending : packed_endings)
      if (there.contains(plain + std::string(ending)))
        return (fs::path(folder) / (plain + std::string(ending))).string();
    return {};
  };
  BagFolder bag;
  std::vector<std::string> names = named_files((fs::path(folder) / metadata_name).string());
  const bool all = names.empty();
  if (all) {
    names.assign(there.begin(), there.end());
    std::sort(names.begin(), names.end(), [](const auto& a, const auto& b) {
      return natural_less(without_packing(a), without_packing(b));
    });
  }
  std::set<std::string> taken;
  for (const std::string& name : names)
    if (taken.insert(without_packing(name)).second) bag.parts.push_back({name, path_of(name)});
  for (const std::string& name : there)
    if (!taken.contains(without_packing(name))) bag.strangers.push_back(name);
  return bag;
}

bool is_bag_metadata(const std::string& file) {
  if (fs::path(file).filename() != metadata_name) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string begin(4096, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.find("rosbag2_bagfile_information:") != std::string::npos;
}

}  // namespace egocal::detail
