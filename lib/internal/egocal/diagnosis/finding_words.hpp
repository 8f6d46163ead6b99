// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "egocal/diagnosis/verdict.hpp"
#include "egocal/error.hpp"

namespace egocal {

/// What a reader calls the things that the library's sentences mark.
struct Terms {
  std::string a = "a", b = "b";  ///< the streams
  std::string solve;             ///< before an option of `egocal solve`, for other commands
};

/// The marks of a sentence, {a}, {b} and {solve}, by these terms.
std::string in_terms(std::string_view marked, const Terms& terms);

/// Message and remedy of a finding in the words given, by the library's own terms.
void say(Finding& finding, FindingWords words);
/// Message and remedy of a finding that holds for the whole drive.
void say(Finding& finding, std::string claim, std::string cure, std::string evidence = {});

/// Message and remedy by the reader's terms. A finding without words has one message and one remedy for all.
std::string message_in_terms(const Finding& finding, const Terms& terms);
std::string remedy_in_terms(const Finding& finding, const Terms& terms);

/// An error that an option of `egocal solve` may cure; what() is by the library's own terms.
class AdvisedError : public Error {
 public:
  explicit AdvisedError(std::string marked);
  std::string in_terms(const Terms& terms) const;

 private:
  std::string marked_;
};

}  // namespace egocal
