// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The codes of findings are an interface: the header lists those that docs/findings.md explains.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "support/file_content.hpp"
#include "support/paths.hpp"

namespace egocal::test_finding_codes {
namespace {

using Codes = std::set<std::string>;

/// In place of the last part of the code before: of "axes_a" and "_both" it is "axes_both".
std::string continued(const std::string& before, const std::string& end) {
  return before.substr(0, before.rfind('_')) + end;
}

/// All codes in the text, each in full or as the end of the one before.
Codes codes_in(const std::string& text, const std::regex& word) {
  Codes codes;
  std::string last;
  for (std::sregex_iterator at(text.begin(), text.end(), word), none; at != none; ++at) {
    const std::string found = (*at)[1];
    last = found.starts_with('_') ? continued(last, found) : found;
    codes.insert(last);
  }
  return codes;
}

/// Rows of a table begin with the codes that they explain.
Codes explained() {
  std::istringstream page(testing::content_of(paths::source_dir() + "/docs/findings.md"));
  Codes codes;
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("| `"))
      codes.merge(codes_in(line.substr(0, line.find('|', 1)), std::regex("`([a-z_]+)`")));
  return codes;
}

/// The comment of Finding::code.
Codes listed() {
  const std::string header =
      testing::content_of(paths::source_dir() + "/lib/include/egocal/diagnosis/verdict.hpp");
  const std::size_t begin = header.find("/// inverted_a|");
  return codes_in(header.substr(begin, header.find(". docs/findings.md", begin) - begin),
                  std::regex("([a-z_]+)"));
}

TEST(FindingCodes, TheHeaderListsWhatThePageExplains) {
  EXPECT_GT(listed().size(), 50U);
  EXPECT_THAT(listed(), ::testing::ContainerEq(explained()));
}

}  // namespace
}  // namespace egocal::test_finding_codes
