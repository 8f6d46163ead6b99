// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/diagnosis/finding_words.hpp"

#include <array>
#include <utility>

namespace egocal {

std::string in_terms(std::string_view marked, const Terms& terms) {
  const std::array<std::pair<std::string_view, std::string_view>, 3> marks{
      {{"{a}", terms.a}, {"{b}", terms.b}, {"{solve}", terms.solve}}};
  std::string text;
  while (!marked.empty()) {
    std::string_view read = marked.substr(0, 1), written = read;
    for (const auto& [mark, term] : marks)
      if (marked.starts_with(mark)) {
        read = mark;
        written = term;
      }
    text += written;
    marked.remove_prefix(read.size());
  }
  return text;
}

void say(Finding& finding, FindingWords words) {
  finding.words = std::move(words);
  finding.message = message_in_terms(finding, {});
  finding.remedy = remedy_in_terms(finding, {});
}

void say(Finding& finding, std::string claim, std::string cure, std::string evidence) {
  say(finding, FindingWords{std::move(claim), std::move(evidence), {}, std::move(cure)});
}

std::string message_in_terms(const Finding& finding, const Terms& terms) {
  const FindingWords& words = finding.words;
  return words.claim.empty() ? finding.message : in_terms(words.claim + words.evidence, terms);
}

std::string remedy_in_terms(const Finding& finding, const Terms& terms) {
  const FindingWords& words = finding.words;
  return words.cure.empty() ? finding.remedy : in_terms(words.scope + words.cure, terms);
}

AdvisedError::AdvisedError(std::string marked)
    : Error(egocal::in_terms(marked, {})), marked_(std::move(marked)) {}

std::string AdvisedError::in_terms(const Terms& terms) const {
  return egocal::in_terms(marked_, terms);
}

}  // namespace egocal
