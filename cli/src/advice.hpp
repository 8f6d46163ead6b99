// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace egocal::cli {

/// The given name that a mistyped word most likely meant; empty: none is close.
std::string closest(const std::string& word, const std::vector<std::string>& names);

/// What is wrong with a word in the place of a command; empty: nothing. CLI11 itself reports that a command
/// is required, or takes a later word for one.
std::string wrong_command(const CLI::App& program, const std::vector<std::string>& arguments);

/// An error as one sentence: what is wrong, what was expected, and what the user may have meant.
std::string in_words(const CLI::ParseError& error, const CLI::App& program);

}  // namespace egocal::cli
