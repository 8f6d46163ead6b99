// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// docs/json.md against what programs print.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/file_content.hpp"
#include "support/paths.hpp"

namespace egocal::test {

using Keys = std::set<std::string>;

/// The texts between backquotes.
inline std::vector<std::string> quoted_in(const std::string& line) {
  std::vector<std::string> texts;
  for (std::size_t at = line.find('`'); at != std::string::npos;) {
    const std::size_t end = line.find('`', at + 1);
    if (end == std::string::npos) break;
    texts.push_back(line.substr(at + 1, end - at - 1));
    at = line.find('`', end + 1);
  }
  return texts;
}

/// Keys by command: a heading names its commands before the colon, a row of a table its keys in the first
/// cell.
inline std::map<std::string, Keys> documented() {
  std::istringstream page(testing::content_of(paths::source_dir() + "/docs/json.md"));
  std::map<std::string, Keys> keys;
  std::vector<std::string> commands;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("## ", 0) == 0) commands = quoted_in(line.substr(0, line.find(':')));
    if (line.rfind("| `", 0) != 0) continue;
    for (const std::string& key : quoted_in(line.substr(0, line.find('|', 1))))
      for (const std::string& command : commands) keys[command].insert(key);
  }
  return keys;
}

/// "fit.tenths[].begin_s" for every value; lists of plain values have the name of the list.
inline void collect(const nlohmann::json& value, const std::string& path, Keys& keys) {
  if (value.is_object() && !value.empty()) {
    for (const auto& [key, below] : value.items())
      collect(below, path.empty() ? key : path + "." + key, keys);
  } else if (value.is_array() && !value.empty() && value[0].is_object()) {
    for (const nlohmann::json& element : value) collect(element, path + "[]", keys);
  } else if (!value.is_array() || value.empty() || !path.ends_with("[]")) {
    keys.insert(path);
  }
}

inline bool covers(const std::string& documented_key, const std::string& key) {
  if (documented_key == key || documented_key.rfind(key + "[].", 0) == 0) return true;  // the latter: empty
  if (!documented_key.ends_with(".*")) return false;
  const std::string parent = documented_key.substr(0, documented_key.size() - 2);
  return key == parent || key.rfind(parent + ".", 0) == 0;
}

/// No key is missing in the page's section `what`, and none is listed there that never appears.
inline void compare_with_page(const std::string& what, const Keys& printed) {
  const Keys known = documented()[what];
  EXPECT_FALSE(known.empty()) << what;
  for (const std::string& key : printed) {
    bool found = false;
    for (const std::string& entry : known) found = found || covers(entry, key);
    EXPECT_TRUE(found) << what << " prints '" << key << "', docs/json.md does not list it";
  }
  for (const std::string& entry : known) {
    bool found = false;
    for (const std::string& key : printed) found = found || covers(entry, key);
    EXPECT_TRUE(found) << "docs/json.md lists '" << entry << "', " << what << " never printed it";
  }
}

}  // namespace egocal::test
