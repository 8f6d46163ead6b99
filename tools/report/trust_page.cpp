// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "report/trust_page.hpp"

#include <fmt/format.h>

#include <sstream>

#include "figures/plot.hpp"
#include "offline/printing/trust.hpp"

namespace egocal::tools {

namespace {

constexpr std::size_t label_cells = 14;  // of a line that `egocal solve` prints

std::string label_of(const std::string& line) {
  const std::string label = line.substr(0, label_cells);
  return label.substr(0, label.find_last_not_of(' ') + 1);
}

std::string value_of(const std::string& line) {
  return line.size() > label_cells ? line.substr(label_cells) : std::string();
}

std::string finding_paragraph(const Finding& finding) {
  std::string text =
      finding.certain ? "<p class='finding'><b>Finding:</b> " : "<p class='possible'><b>Possible:</b> ";
  text += escaped(finding.message);
  if (!finding.remedy.empty()) text += "<br>Cure: " + escaped(finding.remedy);
  return text + "</p>\n";
}

/// Goal and what to drive next, as they are printed: the page and the terminal cannot differ.
std::string goal_paragraphs(const Calibration& calibration) {
  std::istringstream lines(trust_text(calibration));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (label_of(line) == "goal") text += "<p>Goal: " + escaped(value_of(line)) + ".</p>\n";
    if (label_of(line) == "next") text += "<p>Next: " + escaped(value_of(line)) + "</p>\n";
  }
  return text;
}

}  // namespace

std::string trust_page(const Calibration& calibration) {
  std::string text;
  for (const Finding& finding : calibration.findings) text += finding_paragraph(finding);
  if (const std::string fit = fit_in_words(calibration.fit); !fit.empty())
    text += "<p>Fit: " + escaped(fit) + ".</p>\n";
  return text + goal_paragraphs(calibration);
}

std::string table_of_lines(const std::string& text) {
  std::istringstream lines(text);
  std::string table = "<table class='wide'>\n";
  for (std::string line; std::getline(lines, line);)
    table +=
        fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escaped(label_of(line)), escaped(value_of(line)));
  return table + "</table>\n";
}

}  // namespace egocal::tools
