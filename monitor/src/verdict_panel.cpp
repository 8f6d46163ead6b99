// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "answer_text.hpp"
#include "panels.hpp"

namespace egocal::monitor {

namespace {

struct LabelledLine {
  const char* label;
  std::string text;
  Style style;
};

/// The most important lines first: without room for all only the first ones are drawn.
std::vector<LabelledLine> lines_of(const PairVerdict& verdict, Charset charset) {
  const Diagnosis& diagnosis = verdict.diagnosis;
  std::vector<LabelledLine> lines;
  for (const Finding& finding : diagnosis.findings)
    if (finding.certain) lines.push_back({"finding", with_cure(finding), Style::warning});
  if (diagnosis.goal)
    lines.push_back({"goal", goal_text(diagnosis), diagnosis.goal->reached ? Style::good : Style::normal});
  const std::string fit = fit_text(verdict, charset);
  if (!fit.empty()) lines.push_back({"fit", fit, Style::normal});
  for (const Finding& finding : diagnosis.findings)
    if (!finding.certain) lines.push_back({"possible", with_cure(finding), Style::dim});
  return lines;
}

constexpr int label_width = 9;  // columns of the screen

}  // namespace

void draw_verdict(const Pane& pane, const PairState& pair, Charset charset) {
  const calibration_t* answer = pair.answer();
  if (!answer) {
    pane.text(1, 0, "no answer yet", Style::dim);
    return;
  }
  const auto row = [&](int y, const char* label, const Label& what, const std::string& text, Style style) {
    int x = pane.text(1, y, pad_right(label, label_width), Style::dim);
    x = pane.text(x, y, what.text, what.style) + (what.text.empty() ? 0 : 2);
    if (x < pane.width()) pane.text(x, y, clean(text, static_cast<std::size_t>(pane.width() - x)), style);
  };
  row(0, "verdict", verdict_of(pair, charset),
      pair.old > 0 || verdict_is_old(pair) ? advice_of(pair).text
      : !pair.verdict                      ? "is egocal-diagnosis running?"
                                           : pair.verdict->diagnosis.reason,
      Style::normal);
  row(1, "proof", proof_of(*answer),
      "by " + answer->solver + ", gap " + compact(answer->scaled_gap, charset) + " of 1", Style::dim);
  int y = 2;
  if (pair.scale && y < pane.height()) row(y++, "scale", scale_text(*pair.scale, charset), "", Style::normal);
  if (!pair.verdict) return;
  for (const LabelledLine& line : lines_of(*pair.verdict, charset)) {
    if (y >= pane.height()) break;
    row(y++, line.label, {"", Style::normal}, line.text, line.style);
  }
}

}  // namespace egocal::monitor
